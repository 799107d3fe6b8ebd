// SPDX-License-Identifier: BSD-3-Clause
// A row of the table as a method: a coverage and a visibility.
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>
#include <papers/axes/region.hpp>
#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::family {

/// The arguments must outlive the method. Frames need threads. `hierarchical_z` leaves out hidden
/// parts if the row can; no pixel changes. Throws Error{invalid_argument} for a tuning that the
/// coverage does not take.
[[nodiscard]] std::unique_ptr<Method> make_row(const CoverageRow& coverage,
                                               const Visibility& visibility, const Tuning& tuning,
                                               bool hierarchical_z, MemoryAccount& memory);

}  // namespace rastrum::family
