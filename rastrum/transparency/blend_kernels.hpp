// SPDX-License-Identifier: BSD-3-Clause
// The SIMD kernels of blending (blend_simd.cpp), a table per instruction set, with the same bits.
#pragma once

#include <cstdint>

#include <rastrum/frame.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/transparency/over.hpp>

namespace rastrum::transparency {

/// Premultiplied colour so far, and the share of what lies behind that shows through. Alpha has a
/// sum of its own: 1 − through would have only absolute precision, and straight colours divide by
/// alphas of any size.
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

inline void add(raster::BlockColors& sum, const raster::BlockColors& sample) {
  for (int i = 0; i < 64; ++i) {
    sum.r[i] += sample.r[i];
    sum.g[i] += sample.g[i];
    sum.b[i] += sample.b[i];
    sum.a[i] += sample.a[i];
  }
}

struct BlendKernels {
  /// Adds `layer` behind what is seen, at the pixels of `mask`. Returns those where at most
  /// `opaque_at` shows through.
  std::uint64_t (*behind)(const raster::BlockColors& layer, std::uint64_t mask, float opaque_at,
                          Seen& seen) noexcept;
  void (*finish)(const Seen& seen, const raster::BlockColors& behind,
                 raster::BlockColors& out) noexcept;
  /// Puts `layer` over `colors`, at the pixels of `mask`.
  void (*before)(const raster::BlockColors& layer, std::uint64_t mask,
                 raster::BlockColors& colors) noexcept;
};

[[nodiscard]] const BlendKernels& blend_kernels(Isa isa) noexcept;

}  // namespace rastrum::transparency
