// What a light sees: a square picture of depth, and how a place is looked up in it.
#pragma once

#include <rastrum/config.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

struct ShadowMap {
  const float* depth = nullptr;  ///< reversed; row after row
  int size = 0;                  ///< of a row, and how many there are
  /// Columns, rows, depth and w of a place from LightSet::origin: (x, y, z, 1) · row.
  Vec4 column, row, z, w;
  /// A texel's width where w is 1, three times: as far as the lookup reaches. Moved so far along
  /// its normal no plane stands in its own way.
  float offset = 0;

  /// How much of the light reaches place `p` of a surface with unit normal `n`, in [0, 1]: of 4 × 4
  /// texels those that are not nearer to the light, weighed as a square of 3 × 3. What lies beyond
  /// the picture is lit.
  [[nodiscard]] RASTRUM_HD float at(Vec3 p, Vec3 n) const {
    p = p + n * (offset * on(w, p));
    const float scale = 1 / on(w, p);
    const float u = on(column, p) * scale - 0.5F, v = on(row, p) * scale - 0.5F;
    const float d = on(z, p) * scale;
    const auto last = static_cast<float>(size - 3);
    // Written so that a NaN is lit, and what lies behind the light.
    if (!(scale > 0 && u >= 1 && v >= 1 && u < last && v < last)) return 1;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
    const float across[4] = {1 - fx, 1, 1, fx}, down[4] = {1 - fy, 1, 1, fy};
    float sum = 0;
    for (int j = 0; j < 4; ++j) {
      const float* const texel = depth + static_cast<long>(y - 1 + j) * size + (x - 1);
      float line = 0;
      for (int i = 0; i < 4; ++i) line += texel[i] > d ? 0.0F : across[i];
      sum += line * down[j];
    }
    return sum * (1.0F / 9);
  }

 private:
  RASTRUM_HD static float on(const Vec4& r, Vec3 p) {
    return r.x * p.x + r.y * p.y + r.z * p.z + r.w;
  }
};

}  // namespace rastrum::raster
