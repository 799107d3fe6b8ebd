// SPDX-License-Identifier: BSD-3-Clause
// Shadow maps: the depths that a light sees (lights.inl looks places up in them).
#pragma once

#include <rastrum/config.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

struct ShadowMap {
  const float* depth = nullptr;  ///< reversed; row after row
  int width = 0, height = 0;     ///< at least 4
  /// Columns, rows, depth and w of a place from LightSet::origin: (x, y, z, 1) · row.
  Vec4 column, row, z, w;
  /// A texel's width where w is 1, three times: as far as the lookup reaches. Moved so far along
  /// its normal no plane stands in its own way.
  float offset = 0;
};

}  // namespace rastrum::raster
