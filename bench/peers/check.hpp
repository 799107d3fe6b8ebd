// SPDX-License-Identifier: BSD-3-Clause
// Draws one mesh by Rastrum and by OpenGL and reports all differences.
#pragma once

#include <cstdint>
#include <optional>

#include <rastrum/camera.hpp>
#include <rastrum/mesh.hpp>

#include "compare.hpp"
#include "gl_peer.hpp"

namespace rastrum::bench {

/// How many pixels of an image may differ: where vertices lie exactly on 1/256 px, and on meshes.
/// On meshes the vertex arithmetic sometimes rounds differently: llvmpipe fuses the viewport's
/// multiply and add, our picture rules do not. (With both fused, 0 pixels differed in all scenes.)
/// A soup of a million triangles has no neighbours that take over a sample when an edge moves, so
/// more differ, 23 at 1920 × 1080; this limit is for meshes.
inline constexpr std::uint64_t kDifferingPixelsExact = 0, kDifferingPixelsMesh = 3;
/// The least share of covered pixels whose `phong` is within 1/255.
inline constexpr double kPhongShare = 0.999;

struct GlCheck {
  std::uint64_t triangles = 0;
  CountDifference counts;
  std::uint64_t samples_passed = 0;   ///< of OpenGL's query: the sum of its counts
  std::uint64_t stats_fragments = 0;  ///< according to our statistics
  ColorDifference colors;
  std::uint64_t ids = 0;  ///< pixels that show another triangle

  /// Without `differing_pixels` the counts of single pixels are ignored.
  [[nodiscard]] bool passes(std::optional<std::uint64_t> differing_pixels) const {
    return (!differing_pixels || counts.pixels <= *differing_pixels) &&
           colors.share() >= kPhongShare && samples_passed == counts.theirs &&
           stats_fragments == counts.ours;
  }
};

[[nodiscard]] GlCheck check_against(GlPeer& gl, const Mesh& mesh, const Camera& camera, int width,
                                    int height, int threads);

}  // namespace rastrum::bench
