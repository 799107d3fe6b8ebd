// SPDX-License-Identifier: BSD-3-Clause
// A published table beside our figures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <bench/tables/published.hpp>

#include "document.hpp"

namespace rastrum::bench {

/// A figure measured here, in a table's unit.
struct Measured {
  double value = 0;   ///< 0: not run
  double spread = 0;  ///< half the interquartile range over the median
  std::uint64_t scratch_bytes = 0;
  std::uint64_t all_bytes = 0;  ///< scratch, mesh and picture; 0: memory is not shown
  std::string not_run = {};     ///< the reason; empty if nobody asked for it
  std::vector<double> samples_ms = {};
};

struct Comparison {
  struct Row {
    std::string name;  ///< e.g. the rasterizer: a line of a plot
    std::string at;    ///< its place along x, e.g. a size; may be empty
    std::vector<Published> published;
    std::vector<Measured> ours;  ///< may be empty: only the paper's figures
  };
  std::string caption;
  std::string unit;       ///< "ms" (smaller is better) or "FPS"
  std::string paper, us;  ///< e.g. "paper, M2000M" and "here, 2 threads"
  std::string first_column;
  std::vector<std::string> columns;
  std::vector<Row> rows;
};

/// The figures of a constexpr row.
template <std::size_t Columns>
[[nodiscard]] Comparison::Row row_of(const PublishedRow<Columns>& row) {
  return {std::string(row.name),
          std::string(row.at),
          {row.figures.begin(), row.figures.end()},
          std::vector<Measured>(Columns)};
}

/// Appends the table, with a line of the paper's figures and one of ours below each other, and its
/// figures as JSON: {"table", "row", "at", "column", "unit", "published": {…}, "here": {…}}.
void add(Document& document, const Comparison& comparison);

/// A panel per column; x: the rows' `at`; a colour per name; dashed: the paper's, solid: ours.
[[nodiscard]] Plot lines_of(const Comparison& comparison, const std::string& x_title);
/// One panel: a group per column, a bar per row; pale: the paper's.
[[nodiscard]] Plot bars_of(const Comparison& comparison);

}  // namespace rastrum::bench
