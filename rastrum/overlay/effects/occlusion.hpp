// SPDX-License-Identifier: BSD-3-Clause
// Ambient occlusion of a row of pixels and its blur: what the plain and the SIMD kernels share.
// Lengths are in radii.
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
  ImageView<const Vec3> normals;  ///< empty: derived from depth
  bool perspective = true;
  float ux = 0, uy = 0, u0 = 0, vy = 0, v0 = 0;  ///< Lens; orthographic: over the radius
  float per_radius = 0;                          ///< 1 / radius
  float reach_px = 0,
        most_px = 0;  ///< px: the radius at distance 1 (or anywhere); most spread of samples
  float weight = 0;   ///< strength · kOcclusionScale / samples
  int samples = 0;
  int stride = 0;  ///< of `depth`
  /// Row y % 4 of the pattern and sample k have their offset, in parts of the reach, across (axis
  /// 0) and down (1) at [((y % 4) · samples + k) · 2 + axis] · 16 + x % 16.
  std::vector<float> pattern;

  [[nodiscard]] const float* offsets(int y, int sample, int axis) const {
    return pattern.data() + (static_cast<std::size_t>((y % kPatternSide) * samples + sample) * 2 +
                             static_cast<std::size_t>(axis)) *
                                kPatternLanes;
  }
};

// Constants of the plain and the SIMD kernels.
inline constexpr float kOcclusionBias = 0.02F;    ///< of the radius, against a plane's own rounding
inline constexpr float kBiasPerDistance = 2e-6F;  ///< covers the rounding of depth
inline constexpr float kOcclusionEpsilon = 0.01F;  ///< the paper's
inline constexpr float kOcclusionScale =
    4.0F;  ///< chosen by looking: a right angle keeps a quarter
inline constexpr float kBlurSharpness = 2.0F;
inline constexpr int kMostSamples = 64;
inline constexpr float kFarthest = 3.402823466e38F;

/// The five taps of a blur lie `step` apart, in a row of the picture or, `down`, across rows.
struct BlurTaps {
  bool down;
  std::ptrdiff_t step;
};

/// Writes pixels [begin, end) of row y, not blurred. Returns whether any shows a surface. `begin`:
/// a multiple of 16. Empty normals are derived from depth.
using OcclusionKernel = bool (*)(const OcclusionFrame& frame, int y, int begin, int end,
                                 float* out);
/// Writes pixels [begin, end) of row y, blurred, from the values at `in`: 5 taps of weights 1/2, 1,
/// 1, 1, 1/2, less where depths differ, 0 without a surface.
using BlurKernel = void (*)(const OcclusionFrame& frame, const float* in, int y, BlurTaps taps,
                            int begin, int end, float* out);

bool occlusion_plain(const OcclusionFrame& frame, int y, int begin, int end, float* out);
void blur_plain(const OcclusionFrame& frame, const float* in, int y, BlurTaps taps, int begin,
                int end, float* out);

/// out[i] = from[places[i]], load by load: faster here than gather instructions
/// (docs/log/effects.md).
void load_each(const float* from, const std::int32_t* places, int count, float* out) noexcept;

/// The normal of a pixel by depth: across the differences to its neighbours, in each direction the
/// one nearer in depth. (0, 0, 0) if it has none.
[[nodiscard]] Vec3 normal_from_depth(const OcclusionFrame& frame, int x, int y);

[[nodiscard]] OcclusionKernel occlusion_kernel(Isa isa) noexcept;
[[nodiscard]] BlurKernel blur_kernel(Isa isa) noexcept;

/// Throws Error{invalid_argument} for options out of range.
[[nodiscard]] OcclusionFrame occlusion_frame(const Surface& surface, const Camera& camera,
                                             const AmbientOcclusion& options);

}  // namespace rastrum::overlay
