// SPDX-License-Identifier: BSD-3-Clause
// The SIMD leaves of blending (blend_simd.cpp), once for each instruction set and with the same
// bits.
#pragma once

#include <cstdint>

#include <rastrum/frame.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/transparency/over.hpp>

namespace rastrum::transparency {

/// Colour so far, premultiplied, and how much of what lies behind is seen through it. Alpha is
/// summed as colours are: 1 − through has no more than an absolute precision, and straight colours
/// divide by alphas of any size.
struct alignas(64) Seen {
  float r[64], g[64], b[64], a[64], through[64];

  [[nodiscard]] SeenPixel at(int i) const { return {{r[i], g[i], b[i], a[i]}, through[i]}; }
  void set(int i, const SeenPixel& p) {
    r[i] = p.color.x;
    g[i] = p.color.y;
    b[i] = p.color.z;
    a[i] = p.color.w;
    through[i] = p.through;
  }
};

/// Adds the colours of one sample to those of others.
inline void add(raster::BlockColors& sum, const raster::BlockColors& sample) {
  for (int i = 0; i < 64; ++i) {
    sum.r[i] += sample.r[i];
    sum.g[i] += sample.g[i];
    sum.b[i] += sample.b[i];
    sum.a[i] += sample.a[i];
  }
}

struct BlendKernels {
  /// Adds `layer` behind what is seen, at the pixels of `mask`. Returns the pixels of `mask` where
  /// no more than `opaque_at` is seen through.
  std::uint64_t (*behind)(const raster::BlockColors& layer, std::uint64_t mask, float opaque_at,
                          Seen& seen) noexcept;
  /// Sets `out` to `seen` over `behind`.
  void (*finish)(const Seen& seen, const raster::BlockColors& behind,
                 raster::BlockColors& out) noexcept;
  /// Puts `layer` before `colors`, at the pixels of `mask`.
  void (*before)(const raster::BlockColors& layer, std::uint64_t mask,
                 raster::BlockColors& colors) noexcept;
};

[[nodiscard]] const BlendKernels& blend_kernels(Isa isa) noexcept;

}  // namespace rastrum::transparency
