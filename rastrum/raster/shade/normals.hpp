// SPDX-License-Identifier: BSD-3-Clause
// Normals of triangles for shading, safe for all finite coordinates. Called once a visible
// triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// The normal of the triangle's plane, towards the counter-clockwise side; its largest component is
/// 1. Float64, because products of coordinates up to FLT_MAX / 16 overflow float32. 0 without area.
RASTRUM_HD inline Vec3 face_normal(const MeshView& mesh, const std::uint32_t (&vertex)[3]) {
  Vec3d a, u, v;
  if (mesh.positions.is_packed()) {
    // By reference: GCC 12 reads copies back in other parts than it wrote, and stalls.
    const Vec3* const p = mesh.positions.data();
    const Vec3 &p0 = p[vertex[0]], &p1 = p[vertex[1]], &p2 = p[vertex[2]];
    a.x = p0.x, a.y = p0.y, a.z = p0.z;
    u.x = p1.x - a.x, u.y = p1.y - a.y, u.z = p1.z - a.z;
    v.x = p2.x - a.x, v.y = p2.y - a.y, v.z = p2.z - a.z;
  } else {
    a = mesh.positions.wide(vertex[0]);
    u = mesh.positions.wide(vertex[1]) - a;
    v = mesh.positions.wide(vertex[2]) - a;
  }
  const auto [x, y, z] = cross(u, v);
  const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  if (!(largest > 0)) return {};
  return {static_cast<float>(x / largest), static_cast<float>(y / largest),
          static_cast<float>(z / largest)};
}

/// A caller's normal, scaled if its square would leave float32; 0 if it is not finite.
RASTRUM_HD inline Vec3 safe_normal(Vec3 n) {
  const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const float largest = std::max({x, y, z});
  constexpr float kMost = 1e15F;  // tests each: NaN compares as not larger
  if (x < kMost && y < kMost && z < kMost && largest > 1e-15F) return n;
  if (!is_finite(n) || largest == 0) return {};
  return {n.x / largest, n.y / largest, n.z / largest};
}

/// A corner with a zero or non-finite normal gets the face's, on the side of the other corners.
RASTRUM_HD inline void fill_in_normals(const MeshView& mesh, const std::uint32_t (&vertex)[3],
                                       Vec3 (&n)[3]) {
  Vec3 sum;
  bool says[3];
  for (int c = 0; c < 3; ++c) {
    says[c] = is_finite(n[c]) && (n[c].x != 0 || n[c].y != 0 || n[c].z != 0);
    if (says[c]) sum = sum + n[c];
  }
  if (says[0] && says[1] && says[2]) return;
  Vec3 face = normalize(face_normal(mesh, vertex));
  if (dot(face, sum) < 0) face = face * -1;
  for (int c = 0; c < 3; ++c)
    if (!says[c]) n[c] = face;
}

/// In object space.
RASTRUM_HD inline void corner_normals(const MeshView& mesh, const TrianglePlace& place,
                                      const std::uint32_t (&vertex)[3], Vec3 (&out)[3]) {
  if (mesh.normals.values.empty()) {
    out[0] = out[1] = out[2] = face_normal(mesh, vertex);
    return;
  }
  mesh.normals.corners(place, vertex, out);
  for (Vec3& n : out) n = safe_normal(n);
  fill_in_normals(mesh, vertex, out);
}

}  // namespace rastrum::raster
