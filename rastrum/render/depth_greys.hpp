// SPDX-License-Identifier: BSD-3-Clause
// Shader::depth: greys by the range of depths of a whole picture.
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

struct DepthGreys {
  float nearest = 0, scale = 0;
  Rgba8 behind8{};  ///< where no surface is

  [[nodiscard]] float at(float depth) const { return 1 - (nearest - depth) * scale; }
};

/// Likewise for n pixels of a row, by instruction set (depth_greys_simd.cpp), to the same bits.
struct DepthLanes {
  void (*widen)(const float* depth, std::size_t n, DepthRange& range) noexcept = nullptr;
  void (*greys)(const float* depth, std::size_t n, const DepthGreys& greys,
                Rgba8* out) noexcept = nullptr;
};
[[nodiscard]] const DepthLanes& depth_lanes(Isa isa) noexcept;
extern const DepthLanes kScalarDepthLanes;

/// Depths of visibility keys (docs/coverage.md), 0 without a surface. `threads` may be null.
void depths_of_keys(ImageView<const std::uint64_t> keys, ImageView<float> depth,
                    parallel::Threads* threads);

/// Fills color8 and color. The nearest depth, or a single one, is white, the farthest black. A
/// surface at depth 0 becomes background, whose depth it has. `threads` may be null.
void stretch_depth(ImageView<float> depth, Vec4 background, const Targets& targets, Isa isa,
                   parallel::Threads* threads);

}  // namespace rastrum
