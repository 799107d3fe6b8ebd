// The vertex rules of DESIGN section 2 written a second time, for the tests alone: float32, one
// order, no contraction. Of the library it uses only the types and `world_to_clip`.
#pragma once

#include <cstdint>
#include <vector>

#include <rastrum/scene/scene.hpp>

#include "tests/support/oracle.hpp"

namespace rastrum::test {

struct ClipVertex {
  float x = 0, y = 0, z = 0, w = 0;
};

enum class Fate {
  dropped,     ///< a NaN or infinite vertex
  whole,       ///< in front of the near plane and inside the guard band: snapped as it is
  needs_clip,  ///< anything else
};

struct ProjectedTriangle {
  std::int64_t id = 0;
  Fate fate = Fate::dropped;
  ClipVertex clip[3];
  SnappedTriangle snapped;  ///< valid for Fate::whole
};

/// Object to clip: the float64 product, rounded to float32 once.
[[nodiscard]] Mat4 object_to_clip(const Camera& camera, const Mat4d& object_to_world, int width,
                                  int height);

[[nodiscard]] ClipVertex to_clip(const Mat4& object_to_clip, Vec3 position);

/// Every triangle of `scene` in order of submission. Indices must be in range.
[[nodiscard]] std::vector<ProjectedTriangle> project(const SceneView& scene, const Camera& camera,
                                                     int width, int height);

}  // namespace rastrum::test
