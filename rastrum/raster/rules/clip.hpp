// SPDX-License-Identifier: BSD-3-Clause
// Clipping against the near plane and the guard band, only where a vertex needs it.
// The pieces of a triangle depend on the triangle and the full image alone. New vertices are
// computed in float64 from the inside end of an edge to its outside end, so two triangles that
// share the edge get the same vertex and stay watertight. (Sutherland and Hodgman, 1974, and for
// lines Liang and Barsky, 1984, in homogeneous coordinates.)
#pragma once

#include <rastrum/config.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/rules/projection.hpp>

namespace rastrum::raster {

struct Vec4d {
  double x = 0, y = 0, z = 0, w = 0;
};

/// M · (p, 1) in float64, in the order of float32's.
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

/// A triangle cut by five planes (near and the guard band's four) has at most eight corners.
inline constexpr int kMaxPolygon = 8;

struct ClippedPolygon {
  int size = 0;  ///< 0 or 3 … kMaxPolygon
  ProjectedVertex vertices[kMaxPolygon];
};

/// Cuts the triangle `clip` (homogeneous, finite). `projected[i]` is what `project` made of vertex
/// i; where it has a position that position is kept, so unclipped neighbours meet it exactly.
/// `inv_w` of the result is not set: shading uses the original triangle.
[[nodiscard]] RASTRUM_HD ClippedPolygon clip_triangle(const Vec4d (&clip)[3],
                                                      const ProjectedVertex (&projected)[3],
                                                      Viewport viewport) noexcept;

/// Cuts the line `clip` (homogeneous, finite) and puts its ends into `projected`, of which those
/// that have a position keep it. False: nothing is left, `projected` is as before. The result does
/// not depend on the direction of the line.
[[nodiscard]] RASTRUM_HD bool clip_line(const Vec4d (&clip)[2], ProjectedVertex (&projected)[2],
                                        Viewport viewport) noexcept;

/// Projects a point without a position in float32 (finite); false where none of the planes' inside
/// holds it.
[[nodiscard]] RASTRUM_HD bool clip_point(const Vec4d& clip, Viewport viewport,
                                         ProjectedVertex& projected) noexcept;

/// Sign of the triangle's orientation, also where vertices lie behind the eye: > 0 for
/// counter-clockwise (front), 0 where it is seen edge-on.
[[nodiscard]] RASTRUM_HD double orientation(const Vec4d (&clip)[3]) noexcept;

}  // namespace rastrum::raster

#if defined(__CUDACC__)
#include <rastrum/raster/rules/clip_code.hpp>
#endif
