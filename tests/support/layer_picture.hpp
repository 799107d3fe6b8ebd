// SPDX-License-Identifier: BSD-3-Clause
// Frames of translucent scenes, and their differences from each other and from the oracle.
#pragma once

#include <cstdint>
#include <string_view>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/layer_oracle.hpp"
#include "tests/support/layer_program.hpp"

namespace rastrum::test {

/// Has colours, ids, depth and errors; overdraw only on request, because counting it turns
/// hierarchical Z off.
struct LayerPicture : Frame {
  /// 0 if there is none of that name.
  [[nodiscard]] std::uint64_t counter(std::string_view name) const;
  [[nodiscard]] std::uint64_t error_pixels() const;
};

/// Draws into images that begin with nonsense.
[[nodiscard]] LayerPicture take(Painter& renderer, LayerProgram& program,
                                bool with_overdraw = false);
/// The program's draws with another shader.
[[nodiscard]] LayerPicture take(Painter& renderer, LayerProgram& program,
                                const raster::BlockShader& shader);
[[nodiscard]] LayerPicture take(Painter& renderer, const SceneView& scene, const Camera& camera,
                                bool with_overdraw = false);

/// How far a float32 channel may be from the exact blend of n layers of colours in [0, 1]: (4 n +
/// 16) · 2⁻²⁴. The transmittance after k layers is a product of k factors, each rounded twice: 2 k
/// roundings of 2⁻²⁴. A layer's share and its sum are rounded once each, and the shares add up to
/// at most 1. So 3 n + 1 roundings bound the whole. 4 n + 16 leaves room for other orders of the
/// operations, the colour's interpolation, the background and the mean of the samples. That is 1e-5
/// at 38 layers, and less than half a step of 8 bits at 8,000.
[[nodiscard]] double blend_bound(std::uint32_t layers);

enum class Check {
  all,    ///< float32 colours within blend_bound, and the others
  bits8,  ///< 8-bit colours within 1/255, ids and depth the same bits
};
[[nodiscard]] testing::AssertionResult equals_oracle(const LayerPicture& picture,
                                                     const LayerImage& oracle,
                                                     Check check = Check::all);

/// The same bits of all colours, ids and depths.
[[nodiscard]] testing::AssertionResult same_bits(const LayerPicture& a, const LayerPicture& b);

[[nodiscard]] bool same_color_bits(const LayerPicture& a, const LayerPicture& b, std::size_t pixel);

}  // namespace rastrum::test
