// SPDX-License-Identifier: BSD-3-Clause
// One mesh drawn by Rastrum and by OpenGL, and all that differs.
#pragma once

#include <cstdint>
#include <optional>

#include <rastrum/camera.hpp>
#include <rastrum/mesh.hpp>

#include "compare.hpp"
#include "gl_peer.hpp"

namespace rastrum::bench {

/// Pixels an image may differ in where vertices lie exactly on 1/256 px, and on meshes, where the
/// vertex arithmetic of the two rounds differently at times: llvmpipe fuses the viewport's multiply
/// and add, our picture rules do not. (With both fused, 0 pixels differed in all scenes.) A soup of
/// a million triangles has no neighbours that take a sample over when an edge moves, and shows
/// more, 23 at 1920 × 1080; the rule is for meshes.
inline constexpr std::uint64_t kDifferingPixelsExact = 0, kDifferingPixelsMesh = 3;
/// The share of covered pixels whose `phong` is within 1/255.
inline constexpr double kPhongShare = 0.999;

struct GlCheck {
  std::uint64_t triangles = 0;
  CountDifference counts;
  std::uint64_t samples_passed = 0;   ///< OpenGL's query: the sum of its counts
  std::uint64_t stats_fragments = 0;  ///< what our statistics say
  ColorDifference colors;
  std::uint64_t ids = 0;  ///< pixels that show another triangle

  /// Without `differing_pixels` the counts of single pixels are not judged.
  [[nodiscard]] bool passes(std::optional<std::uint64_t> differing_pixels) const {
    return (!differing_pixels || counts.pixels <= *differing_pixels) &&
           colors.share() >= kPhongShare && samples_passed == counts.theirs &&
           stats_fragments == counts.ours;
  }
};

[[nodiscard]] GlCheck check_against(GlPeer& gl, const Mesh& mesh, const Camera& camera, int width,
                                    int height, int threads);

}  // namespace rastrum::bench
