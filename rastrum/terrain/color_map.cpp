#include <rastrum/terrain/color_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <rastrum/terrain/shadow_ray.hpp>

namespace rastrum::terrain {
namespace {

/// Display values at equal steps of t; found by walking L* = 30 + 67 t in CIE Lab through these
/// hues.
constexpr std::array<std::array<double, 3>, 8> kHypsometric{{{36, 79, 56},
                                                             {61, 100, 60},
                                                             {94, 121, 68},
                                                             {139, 138, 82},
                                                             {181, 157, 105},
                                                             {208, 181, 143},
                                                             {224, 210, 191},
                                                             {247, 247, 246}}};

/// The unit vector to the sun: east, south, up.
struct ToSun {
  float x, y, z;
};
ToSun to_sun(const Sun& sun) {
  const SunRay ray = sun_ray({sun.azimuth_deg, 45});
  const double up = std::sin(sun.elevation_deg * std::numbers::pi / 180);
  const double flat = std::cos(sun.elevation_deg * std::numbers::pi / 180);
  return {static_cast<float>(ray.x * flat), static_cast<float>(ray.y * flat),
          static_cast<float>(up)};
}

float shade(float dx, float dy, const ToSun& s, float ambient) {
  const float cosine = (s.z - dx * s.x - dy * s.y) / std::sqrt(1 + dx * dx + dy * dy);
  return ambient + (1 - ambient) * (cosine > 0 ? cosine : 0);
}

}  // namespace

Rgba8 height_color(double t) {
  const double at = (t > 0 ? std::min(t, 1.0) : 0.0) * (kHypsometric.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kHypsometric.size() - 2);
  const double f = at - static_cast<double>(i);
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>(
        std::lround(kHypsometric[i][c] + f * (kHypsometric[i + 1][c] - kHypsometric[i][c])));
  };
  return {channel(0), channel(1), channel(2), 255};
}

Image<Rgba8> colors_by_height(ImageView<const float> heights) {
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

float hill_shade(float dx, float dy, const Sun& sun, float ambient) {
  return shade(dx, dy, to_sun(sun), ambient);
}

Image<float> hill_shading(ImageView<const float> heights, const Sun& sun, float ambient,
                          Tiling tiling) {
  const ToSun to = to_sun(sun);
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
      light(x, y) = shade((at(x + 1, y, own) - at(x - 1, y, own)) / 2,
                          (at(x, y + 1, own) - at(x, y - 1, own)) / 2, to, ambient);
    }
  return light;
}

}  // namespace rastrum::terrain
