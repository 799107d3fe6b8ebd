// SPDX-License-Identifier: BSD-3-Clause
// Shared by tests of rows: options of the reference pictures and of the rows, and the reach of a
// triangle.
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "tests/support/frame.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test {

/// One thread, plain C++, a colour per triangle.
[[nodiscard]] inline RenderOptions reference_options(int width, int height) {
  return RenderOptions({.width = width, .height = height, .shader = Shader::id},
                       {.device = Device::serial});
}
/// The same options with a row.
[[nodiscard]] inline RenderOptions row_options(int width, int height, const std::string& rasterizer,
                                               int threads, const family::Tuning& tuning = {}) {
  return RenderOptions({.width = width, .height = height, .shader = Shader::id},
                       {.device = Device::threads, .threads = threads},
                       {.rasterizer = rasterizer, .tuning = tuning});
}

/// The pixels [x0, x1) × [y0, y1).
struct PixelBox {
  int x0, y0, x1, y1;
  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  [[nodiscard]] int area() const { return empty() ? 0 : (x1 - x0) * (y1 - y0); }
};
/// The pixels whose samples are between the outermost vertices, by testing each.
[[nodiscard]] inline PixelBox box_of(const SnappedTriangle& t, int width, int height) {
  const auto range = [](std::int64_t a, std::int64_t b, std::int64_t c, int size) {
    const auto [low, high] = std::minmax({a, b, c});
    int first = size, end = 0;
    for (int i = 0; i < size; ++i)
      if (256 * i + 128 >= low && 256 * i + 128 <= high) {
        first = std::min(first, i);
        end = i + 1;
      }
    return std::pair{first, end};
  };
  const auto [x0, x1] = range(t.v[0].x_fx8, t.v[1].x_fx8, t.v[2].x_fx8, width);
  const auto [y0, y1] = range(t.v[0].y_fx8, t.v[1].y_fx8, t.v[2].y_fx8, height);
  return {x0, y0, x1, y1};
}

/// Compares surfaces and counters.
[[nodiscard]] inline testing::AssertionResult same_frame(const Frame& a, const Frame& b) {
  if (auto r = same_surfaces(a, b); !r) return r;
  return same_counts(a.stats, b.stats);
}

}  // namespace rastrum::test
