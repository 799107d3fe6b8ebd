// SPDX-License-Identifier: BSD-3-Clause
// Ambient occlusion of a row of pixels and its blur: what the plain kernels and those of each
// instruction set have in common. Lengths are in units of the radius.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <rastrum/device.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/image.hpp>

namespace rastrum::overlay {

inline constexpr int kPatternSide = 4;    ///< pixels after which the pattern repeats
inline constexpr int kPatternLanes = 16;  ///< its row of 4, repeated for the widest vector

struct OcclusionFrame {
  ImageView<const float> depth;
  ImageView<const Vec3> normals;  ///< empty: by depth
  bool perspective = true;
  float ux = 0, uy = 0, u0 = 0, vy = 0, v0 = 0;  ///< Lens; of an orthographic one by the radius
  float per_radius = 0;                          ///< 1 / radius
  float reach_px = 0,
        most_px = 0;  ///< of the radius at distance 1 (anywhere); the most samples spread
  float weight = 0;   ///< strength over the number of samples
  int samples = 0;
  int stride = 0;  ///< of `depth`
  /// The offsets across, then down, of pattern row y % 4 and sample k, in parts of the reach, are
  /// at [((y % 4) · samples + k) · 2 + axis] · 16 + x % 16.
  std::vector<float> pattern;

  [[nodiscard]] const float* offsets(int y, int sample, int axis) const {
    return pattern.data() + (static_cast<std::size_t>((y % kPatternSide) * samples + sample) * 2 +
                             static_cast<std::size_t>(axis)) *
                                kPatternLanes;
  }
};

// Constants that the vector kernels and the plain ones share.
inline constexpr float kOcclusionBias = 0.02F;    ///< of the radius, against a plane's own rounding
inline constexpr float kBiasPerDistance = 2e-6F;  ///< of what depth rounds to
inline constexpr float kOcclusionEpsilon = 0.01F;  ///< the paper's
inline constexpr float kOcclusionScale =
    4.0F;  ///< chosen by looking: a right angle keeps a quarter
inline constexpr float kBlurSharpness = 2.0F;
inline constexpr int kMostSamples = 64;
inline constexpr float kFarthest = 3.402823466e38F;

/// Where a blur's five numbers lie: `step` apart, in a row of the picture or across rows.
struct BlurTaps {
  bool down;
  std::ptrdiff_t step;
};

/// Writes pixels [begin, end) of row y, not blurred; returns whether there is a surface at some.
/// `begin` is a multiple of 16. Without OcclusionFrame::normals they are derived from depth.
using OcclusionKernel = bool (*)(const OcclusionFrame& frame, int y, int begin, int end,
                                 float* out);
/// Writes pixels [begin, end) of row y, blurred, from the numbers at `in`: 5 pixels of weights 1/2,
/// 1, 1, 1, 1/2, less where their depth differs, and 0 where there is no surface.
using BlurKernel = void (*)(const OcclusionFrame& frame, const float* in, int y, BlurTaps taps,
                            int begin, int end, float* out);

bool occlusion_plain(const OcclusionFrame& frame, int y, int begin, int end, float* out);
void blur_plain(const OcclusionFrame& frame, const float* in, int y, BlurTaps taps, int begin,
                int end, float* out);

/// out[i] = from[places[i]]. Load by load, which is faster than the instruction set's gather here
/// (docs/log/effects.md).
void load_each(const float* from, const std::int32_t* places, int count, float* out) noexcept;

/// The normal of a pixel from depth alone: across the differences to the neighbours, of both sides
/// the one that is nearer in depth; (0, 0, 0) where it has none.
[[nodiscard]] Vec3 normal_from_depth(const OcclusionFrame& frame, int x, int y);

[[nodiscard]] OcclusionKernel occlusion_kernel(Isa isa) noexcept;
[[nodiscard]] BlurKernel blur_kernel(Isa isa) noexcept;

/// Throws Error{invalid_argument} for options out of range.
[[nodiscard]] OcclusionFrame occlusion_frame(const Surface& surface, const Camera& camera,
                                             const AmbientOcclusion& options);

}  // namespace rastrum::overlay
