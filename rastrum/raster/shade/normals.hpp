// Normals of triangles for shading, safe for any finite coordinates. Once per visible triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// The normal of the triangle's plane, counter-clockwise in front; its largest component is 1. In
/// float64, because products of coordinates up to FLT_MAX / 16 overflow float32. 0 without area.
RASTRUM_HD inline Vec3 face_normal(const MeshView& mesh, const std::uint32_t (&vertex)[3]) {
  const Vec3d a = mesh.positions.wide(vertex[0]);
  const auto [x, y, z] =
      cross(mesh.positions.wide(vertex[1]) - a, mesh.positions.wide(vertex[2]) - a);
  const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  if (!(largest > 0)) return {};
  return {static_cast<float>(x / largest), static_cast<float>(y / largest),
          static_cast<float>(z / largest)};
}

/// A caller's normal, scaled where its square would leave float32; 0 where it is not finite.
RASTRUM_HD inline Vec3 safe_normal(Vec3 n) {
  const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  if (largest > 1e-15F && largest < 1e15F) return n;
  if (!is_finite(n) || largest == 0) return {};
  return {n.x / largest, n.y / largest, n.z / largest};
}

/// The normals at the corners of a triangle, in object space.
RASTRUM_HD inline void corner_normals(const MeshView& mesh, const TrianglePlace& place,
                                      const std::uint32_t (&vertex)[3], Vec3 (&out)[3]) {
  if (mesh.normals.values.empty()) {
    out[0] = out[1] = out[2] = face_normal(mesh, vertex);
    return;
  }
  for (std::size_t c = 0; c < 3; ++c) out[c] = safe_normal(mesh.normals.at(place, vertex, c));
}

}  // namespace rastrum::raster
