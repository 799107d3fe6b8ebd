// SPDX-License-Identifier: BSD-3-Clause
// A figure as a paper prints it. The papers' tables are data, one file a paper.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace rastrum::bench {

/// Time in ms or frames a second, as the table has it, and peak memory in MB (10⁶ bytes).
/// 0: the paper has none.
struct Published {
  double value = 0, mb = 0;
};

/// A line of a published table, a figure a column. `at` is where the line stands along what the
/// table varies (a size, a share), for those that vary something.
template <std::size_t Columns>
struct PublishedRow {
  std::string_view name;
  std::string_view at;
  std::array<Published, Columns> figures;
};

/// The mesh that a column is measured on.
struct Model {
  std::string_view name;
  std::size_t triangles;
};

}  // namespace rastrum::bench
