// Porter and Duff's `over` at one pixel, premultiplied, in float32: the one order of operations
// that the scalar kernels, the vectors of pixels and the devices keep to, so that all have the same
// bits.
#pragma once

#include <rastrum/core/config.hpp>
#include <rastrum/core/vec.hpp>

namespace rastrum::transparency {

/// Colour so far, and how much of what lies behind is seen through it (Seen has 64 of them).
struct SeenPixel {
  float r = 0, g = 0, b = 0, a = 0, through = 1;
};

/// Adds a layer behind what is seen.
RASTRUM_HD inline void add_behind(SeenPixel& seen, Vec4 layer) {
  const float through = seen.through;
  seen.r += through * layer.x;
  seen.g += through * layer.y;
  seen.b += through * layer.z;
  seen.a += through * layer.w;
  seen.through = through * (1 - layer.w);
}

/// What is seen, over `behind`.
RASTRUM_HD inline Vec4 over(const SeenPixel& seen, Vec4 behind) {
  const float through = seen.through;
  // What nothing is seen through is opaque, whatever the sum was rounded to.
  const float alpha = through * (1 - behind.w) == 0 ? 1 : seen.a + through * behind.w;
  return {seen.r + through * behind.x, seen.g + through * behind.y, seen.b + through * behind.z,
          alpha};
}

/// `layer` before `behind`.
RASTRUM_HD inline Vec4 before(Vec4 layer, Vec4 behind) {
  const float rest = 1 - layer.w;
  return {layer.x + rest * behind.x, layer.y + rest * behind.y, layer.z + rest * behind.z,
          layer.w + rest * behind.w};
}

}  // namespace rastrum::transparency
