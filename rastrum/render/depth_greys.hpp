// SPDX-License-Identifier: BSD-3-Clause
// Shader::depth: greys by the range of depths of a whole picture, once that is known.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/device.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// The range of the depths that are above 0.
struct DepthRange {
  float nearest = 0, farthest = 1;
};

/// How depths become greys.
struct DepthGreys {
  float nearest = 0, scale = 0;
  Rgba8 behind8{};  ///< where nothing is

  [[nodiscard]] float at(float depth) const { return 1 - (nearest - depth) * scale; }
};

/// The same for n pixels of a row, by instruction set (depth_greys_simd.cpp), with the bits of one
/// pixel after the other.
struct DepthLanes {
  void (*widen)(const float* depth, std::size_t n, DepthRange& range) noexcept = nullptr;
  void (*greys)(const float* depth, std::size_t n, const DepthGreys& greys,
                Rgba8* out) noexcept = nullptr;
};
[[nodiscard]] const DepthLanes& depth_lanes(Isa isa) noexcept;
extern const DepthLanes kScalarDepthLanes;

/// The depths of visibility keys (docs/coverage.md), 0 where nothing is. `threads` may be null.
void depths_of_keys(ImageView<const std::uint64_t> keys, ImageView<float> depth,
                    parallel::Threads* threads);

/// Fills color8 and color of `targets`. The nearest depth is white, the farthest black; a single
/// depth is white. A surface at depth 0 becomes background, from which its depth does not tell it.
/// `threads` may be null.
void stretch_depth(ImageView<float> depth, Vec4 background, const Targets& targets, Isa isa,
                   parallel::Threads* threads);

}  // namespace rastrum
