// SPDX-License-Identifier: BSD-3-Clause
// The tables of `rastrum bench transparency`: rows in, a document out.
#pragma once

#include <span>
#include <string>

#include <bench/tables/document.hpp>

#include <papers/paper4/bench/measure.hpp>

namespace rastrum::bench {

/// The peers' goals count from this many triangles on; the bunny has 69,451.
inline constexpr std::uint64_t kGoalTriangles = 69'000;

/// The project's goals that a row misses, in words; empty if none.
[[nodiscard]] std::string missed_goals(const TransparencyRow& row);

/// Appends the tables, the plot and the figures. `absent`: scenes without a file.
void add_transparency(Document& document, std::span<const TransparencyRow> rows,
                      std::span<const std::string> absent);

}  // namespace rastrum::bench
