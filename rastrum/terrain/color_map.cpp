#include <rastrum/terrain/color_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <rastrum/core/elementary.hpp>
#include <rastrum/terrain/shadow_ray.hpp>

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

Image<float> hill_shading(ImageView<const float> heights, const Sun& sun, float ambient,
                          Tiling tiling) {
  check_stride(heights, "the height map");
  const ToSun to = ToSun::of(sun);
  Image<float> light(heights.width, heights.height);
  const auto at = [&](std::int64_t x, std::int64_t y, float own) {
    const float h = heights(static_cast<int>(tiled(x, heights.width, tiling)),
                            static_cast<int>(tiled(y, heights.height, tiling)));
    return std::isfinite(h) ? h : own;
  };
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x) {
      const float own = heights(x, y);
      if (!std::isfinite(own)) continue;
      light(x, y) = to.shade((at(x + 1, y, own) - at(x - 1, y, own)) / 2,
                             (at(x, y + 1, own) - at(x, y - 1, own)) / 2, ambient);
    }
  return light;
}

}  // namespace rastrum::terrain
