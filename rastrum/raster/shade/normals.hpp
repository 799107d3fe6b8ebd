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
  // By reference: GCC 12 reads copies back by other parts than it wrote, and waits for the writes.
  const Vec3 &a = mesh.positions[vertex[0]], &b = mesh.positions[vertex[1]],
             &c = mesh.positions[vertex[2]];
  const double ax = a.x, ay = a.y, az = a.z;
  const double ux = b.x - ax, uy = b.y - ay, uz = b.z - az;
  const double vx = c.x - ax, vy = c.y - ay, vz = c.z - az;
  const double x = uy * vz - uz * vy;
  const double y = uz * vx - ux * vz;
  const double z = ux * vy - uy * vx;
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

/// The normals at the corners of triangle `t`, in object space.
RASTRUM_HD inline void corner_normals(const MeshView& mesh, std::uint64_t t,
                                      const std::uint32_t (&vertex)[3], Vec3 (&out)[3]) {
  if (mesh.normals.values.empty()) {
    out[0] = out[1] = out[2] = face_normal(mesh, vertex);
    return;
  }
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = safe_normal(
        mesh.normals
            .values[mesh.normals.indices.empty() ? vertex[c] : mesh.normals.indices[t * 3 + c]]);
}

}  // namespace rastrum::raster
