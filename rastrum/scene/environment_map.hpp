// SPDX-License-Identifier: BSD-3-Clause
// The data that an Environment makes of its picture, for shading.
#pragma once

#include <cmath>
#include <vector>

#include <rastrum/config.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// A direction's place on the octahedral map, in [0, 1]², by |·| and a division, so with the same
/// bits everywhere. +y is in the middle, −y in the corners.
struct OctahedralPlace {
  float u, v;

  RASTRUM_HD explicit OctahedralPlace(Vec3 d) {
    const float scale = 1 / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
    float a = d.x * scale, b = d.z * scale;
    if (d.y < 0) {
      const float folded_a = (1 - std::fabs(b)) * (a < 0 ? -1.0F : 1.0F);
      const float folded_b = (1 - std::fabs(a)) * (b < 0 ? -1.0F : 1.0F);
      a = folded_a;
      b = folded_b;
    }
    u = a * 0.5F + 0.5F;
    v = b * 0.5F + 0.5F;
  }
};

struct EnvironmentMap {
  /// Level k has the light that a surface of roughness k / (kLevels − 1) mirrors.
  static constexpr int kLevels = 8;
  struct Level {
    /// (size + 2)² texels by rows, RGB and an unused float. A border of one texel repeats those
    /// across the edge, so that look-ups need no test.
    const Vec4* texels = nullptr;
    int size = 0;

    [[nodiscard]] RASTRUM_HD Vec3 at(const OctahedralPlace& p) const {
      const auto n = static_cast<float>(size);
      const float x = p.u * n + 0.5F, y = p.v * n + 0.5F;
      const int column = static_cast<int>(x), row = static_cast<int>(y);
      const float right = x - static_cast<float>(column), down = y - static_cast<float>(row);
      const Vec4* const above = texels + static_cast<long>(row) * (size + 2) + column;
      const Vec4* const below = above + (size + 2);
      const Vec4 c = (above[0] * (1 - right) + above[1] * right) * (1 - down) +
                     (below[0] * (1 - right) + below[1] * right) * down;
      return {c.x, c.y, c.z};
    }
  };
  Level levels[kLevels];

  /// The radiance from direction `d`, of any length; black if that is 0. `roughness` in [0, 1].
  [[nodiscard]] RASTRUM_HD Vec3 at(Vec3 d, float roughness) const {
    const float size = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
    if (!(size > 1e-30F && size < 1e30F)) return {};
    const OctahedralPlace place(d);
    const float level = roughness * (kLevels - 1);
    const int sharper = level >= 0 && level < kLevels - 1 ? static_cast<int>(level) : kLevels - 2;
    const float share = level - static_cast<float>(sharper);
    const Vec3 sharp = levels[sharper].at(place);
    if (share == 0) return sharp;
    return sharp * (1 - share) + levels[sharper + 1].at(place) * share;
  }
};

namespace environment_detail {

/// The light that a matt surface gathers, by its normal n: the cosine's bands 0, 1 and 2 of the
/// picture (a quarter, a half and five sixteenths of Legendre's), divided by π. A white picture
/// gives 1.
struct Gathered {
  Vec3d mean;         ///< of RGB
  Vec3d rise[3];      ///< of each channel, · n
  double bend[3][6];  ///< of each channel, · (xx, yy, zz, xy, yz, zx) of n
};

struct Data {
  Gathered gathered;
  std::vector<Vec4> texels[EnvironmentMap::kLevels];
  EnvironmentMap map;  ///< of `texels`
};

}  // namespace environment_detail
}  // namespace rastrum
