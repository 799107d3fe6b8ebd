// SPDX-License-Identifier: BSD-3-Clause
// Where the samples of a pixel lie: Direct3D 11's standard patterns (D3D11 functional
// specification, section 19.2.4.1).
//
// At a sample that lies (dx, dy) from its pixel's centre a triangle has the coverage and the depth
// that it has at the centre once it is moved by (−dx, −dy): edge functions are integers, and the
// depth formula reads only the difference of the two. So a picture of S samples a pixel may be
// drawn as S pictures of moved pieces; the fast path moves triangles in lanes, where it covers them
// (cover/sampled_keys.hpp).
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

/// 1, 4, 8 or 16 samples; empty for any other number.
[[nodiscard]] std::span<const SampleOffset> sample_offsets(int samples) noexcept;

/// Which sample a piece is for: in its flags.
inline constexpr int kSampleShift = 8;
RASTRUM_HD constexpr int sample_of(const Piece& p) {
  return static_cast<int>(p.flags >> kSampleShift & (kMaxSamples - 1));
}

/// Whether the centre lies halfway between the two.
constexpr bool are_opposite(SampleOffset a, SampleOffset b) {
  return a.x == -b.x && a.y == -b.y;
}
/// How far from the centre they lie at most, in x or y, n.8.
[[nodiscard]] int reach_of(std::span<const SampleOffset> samples) noexcept;

/// The vertex as it is seen from the samples that lie at `by`.
RASTRUM_HD inline ProjectedVertex moved(ProjectedVertex v, SampleOffset by) {
  v.x_fx8 -= by.x;
  v.y_fx8 -= by.y;
  return v;
}
/// The piece as it is at the samples that lie at `by` (points and lines are the same everywhere).
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
/// The piece for sample `number`, which lies at `at`, made from a piece of all samples
/// (kAllSamples).
inline Piece piece_at(const Piece& p, int number, SampleOffset at) {
  Piece own = moved(p, at);
  own.flags = (p.flags & ~kAllSamples) | static_cast<std::uint32_t>(number) << kSampleShift;
  return own;
}

/// Where 64 fragments of a block are shaded, px from the centre of the pixel 8 · row + column that
/// their element stands for: elsewhere in it, in [−0.5, 0.5), or in another pixel of the block,
/// where fragments are packed without regard to their pixels. Multiples of 1/16.
struct alignas(64) ShadingPoints {
  float dx[64] = {}, dy[64] = {};  ///< also defined for lanes that are not shaded
};

}  // namespace rastrum::raster
