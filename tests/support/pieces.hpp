// The oracle's input: whole triangles as the tests' own projection snaps them, clipped ones as the
// library's clipper cuts them (clip_test compares the clipper with float64 by itself).
#pragma once

#include <cstdint>
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
