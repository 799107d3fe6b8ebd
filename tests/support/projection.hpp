// SPDX-License-Identifier: BSD-3-Clause
// A second version of the vertex rules of docs/conventions.md, for tests: float32, in one order,
// without contraction. It uses only the library's types and `world_to_clip`.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <rastrum/scene.hpp>

#include "tests/support/oracle.hpp"
#include "tests/support/point3.hpp"

namespace rastrum::test {

/// float32 values; float64 for a finite vertex whose float32 transform overflows.
struct ClipVertex {
  double x = 0, y = 0, z = 0, w = 0;
};

enum class Fate {
  dropped,     ///< a NaN or infinite vertex
  whole,       ///< in front of the near plane and inside the guard band: snapped directly
  needs_clip,  ///< anything else
};

struct ProjectedTriangle {
  std::int64_t id = 0;
  Fate fate = Fate::dropped;
  bool mirrored = false;  ///< its instance reverses orientation
  ClipVertex clip[3];
  bool has_position[3] = {};  ///< whether each corner is in front and inside the guard band
  SnappedTriangle snapped;    ///< corners with a position; the others are meaningless
};

/// Object to clip, the product in float64.
[[nodiscard]] Mat4d object_to_clip(const Camera& camera, const Mat4d& object_to_world, int width,
                                   int height);

/// The matrix rounded to float32 once, then a float32 transform.
[[nodiscard]] ClipVertex to_clip(const Mat4d& object_to_clip, Vec3 position);

/// False if the vertex is behind the near plane or outside of the guard band.
[[nodiscard]] bool snap(const ClipVertex& c, int width, int height, SnappedVertex& out);

/// Every triangle of `scene` in order of submission. Indices must be in range.
[[nodiscard]] std::vector<ProjectedTriangle> project(const SceneView& scene, const Camera& camera,
                                                     int width, int height);

[[nodiscard]] inline Point3 transformed(const Mat4d& m, Vec3 p) {
  const auto row = [&](int i) {
    return Real(m.m[i][0]) * p.x + Real(m.m[i][1]) * p.y + Real(m.m[i][2]) * p.z + Real(m.m[i][3]);
  };
  return {row(0), row(1), row(2)};
}

/// The weights of the corners at the centre of pixel (px, py) of a W × H picture,
/// perspective-correct, up to a common factor. From the snapped positions or, for a triangle that
/// needs the clipper, from the homogeneous ones.
[[nodiscard]] std::array<Real, 3> exact_weights(const ProjectedTriangle& t, int width, int height,
                                                int px, int py);

}  // namespace rastrum::test
