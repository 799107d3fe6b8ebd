// SPDX-License-Identifier: BSD-3-Clause
// Clips against the near plane and the guard band, only where a vertex needs it. The result depends
// on the triangle and the full image alone. New vertices are computed in float64 from an edge's
// inside end, so triangles that share the edge get the same vertex and stay watertight. (Sutherland
// and Hodgman, 1974; lines: Liang and Barsky, 1984.)
#pragma once

#include <rastrum/config.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/rules/projection.hpp>

namespace rastrum::raster {

struct Vec4d {
  double x = 0, y = 0, z = 0, w = 0;
};

/// M · (p, 1), in the float32 version's order.
[[nodiscard]] RASTRUM_HD inline Vec4d transform_point(const Mat4d& a, Vec3d p) {
  const auto row = [&](int i) {
    return ((a.m[i][0] * p.x + a.m[i][1] * p.y) + a.m[i][2] * p.z) + a.m[i][3];
  };
  return {row(0), row(1), row(2), row(3)};
}
[[nodiscard]] RASTRUM_HD inline Vec4 rounded(Vec4d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
          static_cast<float>(v.w)};
}

/// A triangle cut by five planes (near, guard band) has at most eight corners.
inline constexpr int kMaxPolygon = 8;

struct ClippedPolygon {
  int size = 0;  ///< 0 or 3 … kMaxPolygon
  ProjectedVertex vertices[kMaxPolygon];
};

/// Cuts the finite homogeneous triangle `clip`. Positions in `projected` (from `project`) are kept,
/// so unclipped neighbours meet exactly. Leaves `inv_w` unset: shading uses the original triangle.
[[nodiscard]] RASTRUM_HD ClippedPolygon clip_triangle(const Vec4d (&clip)[3],
                                                      const ProjectedVertex (&projected)[3],
                                                      Viewport viewport) noexcept;

/// Cuts the finite homogeneous line `clip` and writes its ends to `projected`, where an end with a
/// position keeps it. False: nothing is left and `projected` is unchanged. The line's direction
/// changes nothing.
[[nodiscard]] RASTRUM_HD bool clip_line(const Vec4d (&clip)[2], ProjectedVertex (&projected)[2],
                                        Viewport viewport) noexcept;

/// For a finite point without a float32 position. False: outside of a plane.
[[nodiscard]] RASTRUM_HD bool clip_point(const Vec4d& clip, Viewport viewport,
                                         ProjectedVertex& projected) noexcept;

/// > 0: counter-clockwise (front), also with vertices behind the eye. 0: edge-on.
[[nodiscard]] RASTRUM_HD double orientation(const Vec4d (&clip)[3]) noexcept;

}  // namespace rastrum::raster

#if defined(__CUDACC__)
#include <rastrum/raster/rules/clip_code.hpp>
#endif
