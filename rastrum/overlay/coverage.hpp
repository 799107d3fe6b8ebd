// SPDX-License-Identifier: BSD-3-Clause
// How much of each pixel a path covers, in integers.
//
// A pixel has 64 lines, at (j + 1/2) / 64 of its height. Bresenham's division finds where an edge
// crosses a line, rounded down to 1/256 px without losing the remainder. A line is covered where
// its winding number is not 0, so overlapping polygons count once. Upright edges are exact; level
// ones are where they lie at a 64th.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include <rastrum/overlay.hpp>

namespace rastrum::overlay {

inline constexpr int kLinesPerPixel = 64;
inline constexpr int kLineStep = 256 / kLinesPerPixel;  ///< in 1/256 px
inline constexpr std::int32_t kFullCoverage = 256 * kLinesPerPixel;

/// An edge that goes down, and its state on the current line.
struct Edge {
  std::int32_t first, last;  ///< lines, `last` excluded
  std::int32_t x;            ///< in 1/256 px
  std::int64_t rest;         ///< remainder of the division by `height`, in [0, height)
  std::int32_t step;         ///< of x per line
  std::int64_t step_rest, height;
  std::int32_t winding;  ///< +1 downwards, −1 upwards

  void advance() {
    x += step;
    rest += step_rest;
    if (rest >= height) {
      rest -= height;
      ++x;
    }
  }
};

/// The edges of `path` that reach lines [0, lines), by first line, then from left to right.
[[nodiscard]] std::vector<Edge> edges_of(const Path& path, std::int32_t lines);

/// Calls row(y, begin, end, coverage) for each row of width × height px that the path reaches:
/// coverage[x] in [0, 255] for x in [begin, end).
template <class Row>
void for_each_covered_row(const Path& path, int width, int height, Row&& row) {
  const std::int32_t lines = height * kLinesPerPixel, right = width * 256;
  const std::vector<Edge> edges = edges_of(path, lines);
  if (edges.empty()) return;
  std::vector<Edge> active, merged;
  const auto further_left = [](const Edge& a, const Edge& b) { return a.x < b.x; };
  std::vector<std::int32_t> sums(static_cast<std::size_t>(width) + 1);
  std::vector<std::int32_t> areas(static_cast<std::size_t>(width) + 1);
  std::vector<std::uint8_t> coverage(static_cast<std::size_t>(width));
  std::size_t next = 0;
  std::int32_t line = edges.front().first;
  int begin = width, end = 0;  // pixels that this row's spans touch
  // Covers all right of x. `sums` counts whole pixels, `areas` the share of x's own, so a span
  // costs only its ends.
  const auto add = [&](std::int32_t x, std::int32_t sign) {
    const auto pixel = static_cast<std::size_t>(x >> 8);
    areas[pixel] += sign * (256 - (x & 255));
    sums[pixel] += sign;
  };
  const auto finish_row = [&](int y) {
    if (begin >= end) return;
    std::int32_t whole = 0;
    for (int x = begin; x < end; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const std::int32_t covered = whole * 256 + areas[i];
      whole += sums[i];
      sums[i] = areas[i] = 0;
      coverage[i] = static_cast<std::uint8_t>((covered * 255 + kFullCoverage / 2) / kFullCoverage);
    }
    sums[static_cast<std::size_t>(end)] = areas[static_cast<std::size_t>(end)] = 0;
    row(y, begin, end, coverage.data());
    begin = width;
    end = 0;
  };
  while (next < edges.size() || !active.empty()) {
    if (active.empty()) {
      if (edges[next].first / kLinesPerPixel != line / kLinesPerPixel)
        finish_row(line / kLinesPerPixel);
      line = std::max(line, edges[next].first);
    }
    // Edges are nearly sorted from the line before, so insertion sort is fast. New ones are merged
    // in, because strokes begin many at once.
    for (std::size_t i = 1; i < active.size(); ++i) {
      const Edge edge = active[i];
      std::size_t j = i;
      for (; j > 0 && active[j - 1].x > edge.x; --j) active[j] = active[j - 1];
      active[j] = edge;
    }
    const std::size_t begins = next;
    while (next < edges.size() && edges[next].first == line) ++next;
    if (next != begins) {
      merged.clear();
      const auto at = [&](std::size_t i) { return edges.begin() + static_cast<std::ptrdiff_t>(i); };
      std::merge(active.begin(), active.end(), at(begins), at(next), std::back_inserter(merged),
                 further_left);
      active.swap(merged);
    }
    std::int32_t winding = 0, from = 0;
    for (Edge& edge : active) {
      const std::int32_t before = winding;
      winding += edge.winding;
      if (before == 0) from = edge.x;
      if (winding != 0) continue;
      const std::int32_t x0 = std::clamp(from, 0, right), x1 = std::clamp(edge.x, 0, right);
      if (x0 == x1) continue;
      add(x0, 1);
      add(x1, -1);
      begin = std::min(begin, x0 >> 8);
      end = std::max(end, std::min(width, (x1 + 255) >> 8));
    }
    ++line;
    std::erase_if(active, [&](const Edge& edge) { return edge.last <= line; });
    for (Edge& edge : active) edge.advance();
    if (line % kLinesPerPixel == 0 || (active.empty() && next == edges.size()))
      finish_row((line - 1) / kLinesPerPixel);
  }
}

}  // namespace rastrum::overlay
