// SPDX-License-Identifier: BSD-3-Clause
// Shadow maps: the depths that a light sees. lights.inl looks them up.
#pragma once

#include <rastrum/config.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

struct ShadowMap {
  const float* depth = nullptr;  ///< reversed; row by row
  int width = 0, height = 0;     ///< at least 4
  /// Column, row, depth and w of a place relative to LightSet's origin: (x, y, z, 1) · row.
  Vec4 column, row, z, w;
  /// Three texel widths at w = 1, as far as the lookup reaches. A place moved so far along its
  /// normal is not shadowed by its own plane.
  float offset = 0;
};

}  // namespace rastrum::raster
