// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/color_map.hpp>

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/under_light.hpp>

namespace rastrum::terrain {
ToSun ToSun::of(const Sun& sun) {
  const SunRay ray = sun_ray({sun.azimuth_deg, 45});
  const auto [up, flat] = elementary::sin_cos(sun.elevation_deg * std::numbers::pi / 180);
  return {static_cast<float>(ray.x * flat), static_cast<float>(ray.y * flat),
          static_cast<float>(up)};
}

Image<Rgba8> colors_by_height(ImageView<const float> heights) {
  check_stride(heights, "the height map");
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x)
      if (const float h = heights(x, y); std::isfinite(h)) {
        low = std::min(low, h);
        high = std::max(high, h);
      }
  const double scale = high > low ? 1 / (static_cast<double>(high) - static_cast<double>(low)) : 0;
  Image<Rgba8> colors(heights.width, heights.height);
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x) {
      const float h = heights(x, y);
      colors(x, y) = std::isfinite(h)
                         ? height_color((static_cast<double>(h) - static_cast<double>(low)) * scale)
                         : Rgba8{0, 0, 0, 255};
    }
  return colors;
}

Vec2 Slopes::at(int x, int y) const {
  const float own = heights(x, y);
  const auto height = [&](std::int64_t u, std::int64_t v) {
    const float h = heights(static_cast<int>(tiled(u, heights.width, tiling)),
                            static_cast<int>(tiled(v, heights.height, tiling)));
    return std::isfinite(h) ? h : own;
  };
  const std::int64_t i = x, j = y;
  return {(height(i + 1, j) - height(i - 1, j)) / 2, (height(i, j + 1) - height(i, j - 1)) / 2};
}

Image<float> hill_shading(ImageView<const float> heights, const Sun& sun, float ambient,
                          Tiling tiling) {
  check_stride(heights, "the height map");
  const ToSun to = ToSun::of(sun);
  const Slopes slopes{heights, tiling};
  Image<float> light(heights.width, heights.height);
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x) {
      if (!std::isfinite(heights(x, y))) continue;
      const Vec2 slope = slopes.at(x, y);
      light(x, y) = to.shade(slope.x, slope.y, ambient);
    }
  return light;
}

Rgba8 shown(Vec4 display) {
  const auto channel = [](float v) {
    return static_cast<std::uint8_t>((v > 0 ? (v < 1 ? v : 1.0F) : 0.0F) * 255 + 0.5F);
  };
  return {channel(display.x), channel(display.y), channel(display.z), 255};
}

Image<Rgba8> colors_of_heights(ImageView<const float> heights, const ScalarColors& colors,
                               double cells_a_unit, int finer, Tiling tiling, int threads) {
  const FloatScope floats;
  check_stride(heights, "the height map");
  if (!(std::isfinite(cells_a_unit) && cells_a_unit != 0))
    reject("colours of heights: a unit must be some cells high, got ", cells_a_unit);
  if (finer == 0 && !heights.empty())
    finer =
        static_cast<int>(std::clamp(std::sqrt(0x1p24 / heights.width / heights.height), 1.0, 4.0));
  if (finer < 1 || finer > kMaxFiner)
    reject("colours of heights: finer must lie in 0 to ", kMaxFiner, ", got ", finer);
  if (heights.width > kMaxImageSize / finer || heights.height > kMaxImageSize / finer)
    reject("colours of heights: ", heights.width, "x", heights.height, " cells, ", finer,
           " times as fine, are beyond 32768x32768");
  Image<Rgba8> out(heights.width * finer, heights.height * finer);
  const std::vector<Tap> across = scaled_taps(heights.width, out.width(), finer > 1, tiling),
                         down = scaled_taps(heights.height, out.height(), finer > 1, tiling);
  parallel::Threads exec(threads);
  parallel::for_each_index(exec, static_cast<std::size_t>(out.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < out.width(); ++x) {
      const float h = between(heights, across[static_cast<std::size_t>(x)], down[row]);
      out(x, y) = shown(colors(static_cast<double>(h) / cells_a_unit));
    }
  });
  return out;
}

}  // namespace rastrum::terrain
