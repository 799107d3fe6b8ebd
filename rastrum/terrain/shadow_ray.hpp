// SPDX-License-Identifier: BSD-3-Clause
// The ray from the middle of a cell to the sun, as the list of cells that it enters. One list
// serves all cells (Amanatides and Woo, "A fast voxel traversal algorithm", 1987, done once instead
// of once per cell).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <rastrum/terrain_light.hpp>

namespace rastrum::terrain {

/// The direction to the sun over the ground, a unit vector, and the climb per cell length. Suns at
/// multiples of 45° lie exactly on axes and diagonals.
struct SunRay {
  double x = 0, y = 0, rise = 0;
};

/// Throws Error{invalid_argument} for angles that are not finite, or an elevation above 90°.
[[nodiscard]] SunRay sun_ray(const Sun& sun);

/// Throws Error{invalid_argument} for a march that is not above 0 to kLongestShadow cells long, or
/// whose steps are out of range.
void check(const March& march);

/// The longest shadow, in cells of the axis that the ray follows.
inline constexpr int kLongestShadow = 65536;

/// Raises a sun above the horizon until no shadow on this relief is longer than that.
[[nodiscard]] SunRay sun_ray(const Sun& sun, double relief);

/// The mean of soft_light if `seen` of `points` points are visible.
[[nodiscard]] RASTRUM_HD constexpr std::uint8_t part_of_suns(std::uint32_t seen,
                                                             std::uint32_t points) {
  return static_cast<std::uint8_t>((seen * 255 + points / 2) / points);
}

struct RayStep {
  std::int32_t dx = 0, dy = 0;  ///< from the cell where the ray begins
  double climb = 0;             ///< of the ray until it enters the cell
};

/// Until the ray has climbed more than `relief`. Requires rise > 0.
[[nodiscard]] std::vector<RayStep> ray_steps(const SunRay& ray, double relief);

/// Heights with holes as −inf, and the range of the others.
struct ShadowCaster {
  ImageView<const float> heights;
  Tiling tiling = Tiling::repeat;
  float lowest = 0, highest = 0;
  [[nodiscard]] double relief() const {
    return static_cast<double>(highest) - static_cast<double>(lowest);
  }
  [[nodiscard]] RASTRUM_HD float at(std::int64_t x, std::int64_t y) const {
    const auto inside = [](std::int64_t i, std::int64_t n) { return i >= 0 && i < n; };
    if (!inside(x, heights.width)) x = tiled(x, heights.width, tiling);
    if (!inside(y, heights.height)) y = tiled(y, heights.height, tiling);
    return heights(static_cast<int>(x), static_cast<int>(y));
  }
};

/// The definition for one cell.
[[nodiscard]] inline bool in_shadow(const ShadowCaster& map, const std::vector<RayStep>& steps,
                                    int x, int y) {
  const auto own = static_cast<double>(map.heights(x, y));
  if (own == -std::numeric_limits<double>::infinity()) return false;
  for (const RayStep& s : steps) {
    const double ray = own + s.climb;
    if (ray >= static_cast<double>(map.highest)) return false;
    if (static_cast<double>(map.at(x + s.dx, y + s.dy)) > ray) return true;
  }
  return false;
}

}  // namespace rastrum::terrain
