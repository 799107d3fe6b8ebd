// SPDX-License-Identifier: BSD-3-Clause
// Where the samples of a pixel lie: Direct3D 11's standard patterns (D3D11 functional
// specification, section 19.2.4.1).
//
// At a sample (dx, dy) from the centre a triangle has the coverage and depth that it would have at
// the centre if moved by (−dx, −dy): edge functions are integers, and the depth formula reads only
// the difference. So S samples a pixel can be drawn as S pictures of moved pieces. The fast path
// moves triangles in lanes, where it covers them (cover/sampled_keys_simd.cpp).
#pragma once

#include <cstdint>
#include <span>

#include <rastrum/config.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::raster {

inline constexpr int kMaxSamples = 16;

/// From the pixel's centre, n.8, y down.
struct SampleOffset {
  std::int32_t x = 0, y = 0;
};

/// Empty unless `samples` is 1, 4, 8 or 16.
[[nodiscard]] std::span<const SampleOffset> sample_offsets(int samples) noexcept;

inline constexpr int kSampleShift = 8;
RASTRUM_HD constexpr int sample_of(const Piece& p) {
  return static_cast<int>(p.flags >> kSampleShift & (kMaxSamples - 1));
}

constexpr bool are_opposite(SampleOffset a, SampleOffset b) {
  return a.x == -b.x && a.y == -b.y;
}
/// The largest distance from the centre in x or y, n.8.
[[nodiscard]] int reach_of(std::span<const SampleOffset> samples) noexcept;

RASTRUM_HD inline ProjectedVertex moved(ProjectedVertex v, SampleOffset by) {
  v.x_fx8 -= by.x;
  v.y_fx8 -= by.y;
  return v;
}
/// Points and lines are the same at all samples.
RASTRUM_HD inline Piece moved(Piece p, SampleOffset by) {
  if (!has_corners(p)) return p;
  for (int c = 0; c < 3; ++c) {
    p.x[c] -= by.x;
    p.y[c] -= by.y;
  }
  return p;
}
/// Whether Kernels::raise_samples draws it.
constexpr bool is_raised_at_once(const Piece& p) {
  return (p.flags & (kAllSamples | kMayDrop)) == kAllSamples;
}
/// The piece for sample `number`, which lies at `at`. `p` is for all samples (kAllSamples).
inline Piece piece_at(const Piece& p, int number, SampleOffset at) {
  Piece own = moved(p, at);
  own.flags = (p.flags & ~kAllSamples) | static_cast<std::uint32_t>(number) << kSampleShift;
  return own;
}

/// Where 64 fragments of a block are shaded, px from the centre of pixel 8 · row + column: in
/// [−0.5, 0.5) within that pixel, or anywhere in the block where fragments are packed. Multiples of
/// 1/16.
struct alignas(64) ShadingPoints {
  float dx[64] = {}, dy[64] = {};  ///< also defined for lanes that are not shaded
};

}  // namespace rastrum::raster
