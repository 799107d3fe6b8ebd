// SPDX-License-Identifier: BSD-3-Clause
// The oracle of spheres, cylinders, cones, tubes and discs: a ray through a pixel's centre, in long
// double, against each primitive. It shares no code with the library: rays are points and
// directions (no homogeneous matrix), and points between the roots decide what is inside, not
// intervals of depth. Deliberately plain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/point3.hpp"

namespace rastrum::test {

enum class SurfaceKind : std::uint8_t { sphere, closed_cone, open_cone, tube, disc, triangle };

/// Keeps n · p + offset ≥ 0.
struct OraclePlane {
  Point3 normal;
  Real offset = 0;
  bool in_object_space = false;
};

struct SurfacePrimitive {
  SurfaceKind kind = SurfaceKind::sphere;
  Point3 p0, p1;  ///< object space; a disc's p1 is its normal
  Real r0 = 0, r1 = 0;
  Point3 p2{};  ///< of a triangle
  /// World = columns · object + origin.
  Point3 columns[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Point3 origin;
  std::int64_t id = 0;
  std::size_t instance = 0;
  bool culls_front = false, culls_back = false;
  std::vector<OraclePlane> planes{};  ///< all planes must keep a point

  [[nodiscard]] Point3 to_world(const Point3& p) const {
    return columns[0] * p.x + columns[1] * p.y + columns[2] * p.z + origin;
  }
};

/// The camera looks from `eye` along −z of its axes.
struct OracleCamera {
  Point3 eye, right, up, back;  ///< orthonormal
  bool orthographic = false;
  Real px_scale = 1;                   ///< a pixel's extent at distance 1 (orthographic: anywhere)
  Real near_plane = 0, far_plane = 0;  ///< far 0: infinite
  int width = 0, height = 0;
};

/// A surface that a ray passes at or beyond the near plane.
struct SurfaceHit {
  Real depth;  ///< reversed, not clamped to [0, 1]
  std::int64_t id;
  bool front;       ///< the ray enters there
  Point3 normal;    ///< world, outward, not normalized; not for triangles
  Point3 position;  ///< world
  Real view_depth;  ///< along the axis
  Real along;       ///< place on the primitive's axis, from 0 to 1; 0 if it has none
};

/// The surfaces that the ray through (x_px, y_px) hits, nearest first.
[[nodiscard]] std::vector<SurfaceHit> surfaces_at(const OracleCamera& camera,
                                                  const std::vector<SurfacePrimitive>& scene,
                                                  Real x_px, Real y_px);

}  // namespace rastrum::test
