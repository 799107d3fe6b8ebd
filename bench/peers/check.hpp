// One mesh drawn by Rastrum and by OpenGL, and all that differs.
#pragma once

#include <cstdint>

#include <rastrum/scene/camera.hpp>
#include <rastrum/scene/mesh.hpp>

#include "compare.hpp"
#include "gl_peer.hpp"

namespace rastrum::bench {

/// Pixels an image may differ in where vertices lie exactly on 1/256 px, and on meshes, where the
/// vertex arithmetic of the two rounds differently at times.
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

  [[nodiscard]] bool passes(std::uint64_t differing_pixels) const {
    return counts.pixels <= differing_pixels && colors.share() >= kPhongShare &&
           samples_passed == counts.theirs && stats_fragments == counts.ours;
  }
};

[[nodiscard]] GlCheck check_against(GlPeer& gl, const Mesh& mesh, const Camera& camera, int width,
                                    int height, int threads);

/// The default camera of one mesh.
[[nodiscard]] Camera fit(const Mesh& mesh);

}  // namespace rastrum::bench
