// SPDX-License-Identifier: BSD-3-Clause
// The oracle's input: whole triangles as the tests' own projection snaps them, clipped ones from
// the library's clipper, which clip_test compares with float64.
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
  std::uint64_t clipped = 0;  ///< sent to the clipper, whatever it returned
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
/// Points and lines, whole or as the library's clipper cuts them; empty if nothing is left.
[[nodiscard]] std::optional<SnappedVertex> point_of(const PieceCorner& p, int width, int height);
[[nodiscard]] std::optional<std::array<SnappedVertex, 2>> line_of(const PieceCorner& a,
                                                                  const PieceCorner& b, int width,
                                                                  int height);

/// > 0: front-facing, clipped or not.
[[nodiscard]] double facing_of(const ProjectedTriangle& t);

/// The library's polygon of a triangle: homogeneous positions, and screen positions of those
/// corners that have one (the corners of Fate::whole).
[[nodiscard]] raster::ClippedPolygon clip(const ProjectedTriangle& t, int width, int height);

/// The pieces of the polygon: a fan from the first corner, without slivers that snapping flipped.
[[nodiscard]] std::vector<SnappedTriangle> fan_of(const raster::ClippedPolygon& polygon, bool front,
                                                  std::int64_t id);

/// The triangles of `scene` that `cull` leaves, in order of submission.
[[nodiscard]] PieceList pieces_of(const SceneView& scene, const Camera& camera, int width,
                                  int height, Cull cull = Cull::none);

}  // namespace rastrum::test
