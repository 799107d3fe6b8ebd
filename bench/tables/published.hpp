// SPDX-License-Identifier: BSD-3-Clause
// A figure as a paper prints it. The papers' tables are data, one file per paper.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace rastrum::bench {

/// Time in ms or frames a second, as in the table, and peak memory in MB (10⁶ bytes). 0: not given.
struct Published {
  double value = 0, mb = 0;
};

/// A line of a published table, with a figure per column. `at` is the line's value of what the
/// table varies (a size, a share), if anything.
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
