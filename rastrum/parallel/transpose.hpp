// SPDX-License-Identifier: BSD-3-Clause
// transpose: out[x · rows + y] = in[y · columns + x].
//
// Work O(n), span O(kTransposeTile² + log n). Tiles stay in the cache; otherwise each element
// written would cost a cache line. Allocates nothing. Source: Futhark's transpose.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

inline constexpr std::size_t kTransposeTile = 32;

/// `in`: rows × columns elements, row after row; `out`: as many, not overlapping `in`.
template <Readable In, Writable Out>
void transpose(Serial&, const In& in, std::size_t rows, std::size_t columns, Out&& out) {
  assert(std::size(in) == rows * columns && std::size(out) == rows * columns);
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x) out[x * rows + y] = in[y * columns + x];
}

template <Readable In, Writable Out>
void transpose(Threads& exec, const In& in, std::size_t rows, std::size_t columns, Out&& out) {
  assert(std::size(in) == rows * columns && std::size(out) == rows * columns);
  const std::size_t across = (columns + kTransposeTile - 1) / kTransposeTile;
  const std::size_t down = (rows + kTransposeTile - 1) / kTransposeTile;
  for_each_index(exec, across * down, [&](std::size_t tile) {
    const std::size_t x0 = tile % across * kTransposeTile, y0 = tile / across * kTransposeTile;
    const std::size_t x1 = std::min(columns, x0 + kTransposeTile);
    const std::size_t y1 = std::min(rows, y0 + kTransposeTile);
    for (std::size_t x = x0; x < x1; ++x)
      for (std::size_t y = y0; y < y1; ++y) out[x * rows + y] = in[y * columns + x];
  });
}

}  // namespace rastrum::parallel
