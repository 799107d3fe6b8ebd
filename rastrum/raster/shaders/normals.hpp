// Normals of triangles for shading, safe for any finite coordinates. Once per visible triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <rastrum/core/vec.hpp>
#include <rastrum/scene/mesh.hpp>

namespace rastrum::raster {

/// The normal of the triangle's plane, counter-clockwise in front; its largest component is 1. In
/// float64, because products of coordinates up to FLT_MAX / 16 overflow float32. 0 without area.
inline Vec3 face_normal(const MeshView& mesh, const std::uint32_t (&vertex)[3]) {
  const Vec3 a = mesh.positions[vertex[0]];
  double e[2][3];
  for (int i = 0; i < 2; ++i) {
    const Vec3 b = mesh.positions[vertex[i + 1]];
    e[i][0] = static_cast<double>(b.x) - static_cast<double>(a.x);
    e[i][1] = static_cast<double>(b.y) - static_cast<double>(a.y);
    e[i][2] = static_cast<double>(b.z) - static_cast<double>(a.z);
  }
  const double x = e[0][1] * e[1][2] - e[0][2] * e[1][1];
  const double y = e[0][2] * e[1][0] - e[0][0] * e[1][2];
  const double z = e[0][0] * e[1][1] - e[0][1] * e[1][0];
  const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  if (!(largest > 0)) return {};
  return {static_cast<float>(x / largest), static_cast<float>(y / largest),
          static_cast<float>(z / largest)};
}

/// A caller's normal, scaled where its square would leave float32; 0 where it is not finite.
inline Vec3 safe_normal(Vec3 n) {
  const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  if (largest > 1e-15F && largest < 1e15F) return n;
  if (!is_finite(n) || largest == 0) return {};
  return {n.x / largest, n.y / largest, n.z / largest};
}

/// The normals at the corners of triangle `t`, in object space.
inline void corner_normals(const MeshView& mesh, std::uint64_t t, const std::uint32_t (&vertex)[3],
                           Vec3 (&out)[3]) {
  if (mesh.normals.empty()) {
    out[0] = out[1] = out[2] = face_normal(mesh, vertex);
    return;
  }
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = safe_normal(
        mesh.normals
            .values[mesh.normals.indices.empty() ? vertex[c] : mesh.normals.indices[t * 3 + c]]);
}

}  // namespace rastrum::raster
