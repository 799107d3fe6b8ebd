// SPDX-License-Identifier: BSD-3-Clause
// The oracle's input: whole triangles as the tests' own projection snaps them, clipped ones as the
// library's clipper cuts them (clip_test compares the clipper with float64 by itself).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/raster/rules/clip.hpp>

#include "tests/support/projection.hpp"

namespace rastrum::test {

struct PieceList {
  std::vector<SnappedTriangle> triangles;
  std::uint64_t input = 0, dropped = 0;
  std::uint64_t clipped = 0;  ///< sent to the clipper, whatever came back
};

/// A vertex as the clipper takes it: in clip space, and snapped if it is `whole`.
struct PieceCorner {
  ClipVertex clip;
  bool whole = false;
  SnappedVertex snapped;
};
[[nodiscard]] inline PieceCorner corner_of(const ProjectedTriangle& t, std::size_t i) {
  return {t.clip[i], t.has_position[i], t.snapped.v[i]};
}
/// Points and lines as they are, or as the library's clipper cuts them; none: nothing is left.
[[nodiscard]] std::optional<SnappedVertex> point_of(const PieceCorner& p, int width, int height);
[[nodiscard]] std::optional<std::array<SnappedVertex, 2>> line_of(const PieceCorner& a,
                                                                  const PieceCorner& b, int width,
                                                                  int height);

/// > 0: seen from the front, whether or not it is clipped.
[[nodiscard]] double facing_of(const ProjectedTriangle& t);

/// The library's polygon of a triangle: homogeneous positions and the positions of those corners
/// that have one (Fate::whole by themselves).
[[nodiscard]] raster::ClippedPolygon clip(const ProjectedTriangle& t, int width, int height);

/// The pieces of the polygon: its fan from the first corner, without the slivers that snapping
/// turned over.
[[nodiscard]] std::vector<SnappedTriangle> fan_of(const raster::ClippedPolygon& polygon, bool front,
                                                  std::int64_t id);

/// All that `cull` leaves of `scene`, in order of submission.
[[nodiscard]] PieceList pieces_of(const SceneView& scene, const Camera& camera, int width,
                                  int height, Cull cull = Cull::none);

}  // namespace rastrum::test
