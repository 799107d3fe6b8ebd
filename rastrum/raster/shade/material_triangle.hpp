// SPDX-License-Identifier: BSD-3-Clause
// A triangle, and a point in it, for the material shader and alpha: for the host's lanes
// (material_simd.cpp) and the scalar form (material_scalar.hpp).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/normals.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

RASTRUM_HD_LEAF Vec3 times(const float (&m)[3][3], Vec3 v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
          m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

struct CornerShares {
  double scale;            ///< 1 / Σ weights
  float weight1, weight2;  ///< normalized

  /// At (dx, dy) px from the planes' origin.
  [[nodiscard]] RASTRUM_HD_LEAF static CornerShares at(const WeightPlanes& w, double dx,
                                                       double dy) {
    const double b0 = w.r[0] + w.p[0] * dx + w.q[0] * dy;
    const double b1 = w.r[1] + w.p[1] * dx + w.q[1] * dy;
    const double b2 = w.r[2] + w.p[2] * dx + w.q[2] * dy;
    const double s = 1 / (b0 + b1 + b2);
    return {s, static_cast<float>(b1 * s), static_cast<float>(b2 * s)};
  }
  /// An attribute's difference from corner 0. `d1`, `d2`: those of the other corners. Exactly 0 if
  /// it is constant.
  [[nodiscard]] RASTRUM_HD_LEAF float offset(float d1, float d2) const {
    return weight1 * d1 + weight2 * d2;
  }
};

struct Coordinate {
  float value, dx, dy;
};

struct CoordinatePlane {
  float a0, d1, d2;     ///< at corner 0, and the differences of the other corners
  double p, q, px, qy;  ///< Σ bᵢ′ and Σ bᵢ′ dᵢ, along x and y

  RASTRUM_HD CoordinatePlane(const WeightPlanes& w, float at0, float more1, float more2)
      : a0(at0),
        d1(more1),
        d2(more2),
        p(w.p[0] + w.p[1] + w.p[2]),
        q(w.q[0] + w.q[1] + w.q[2]),
        px(w.p[1] * more1 + w.p[2] * more2),
        qy(w.q[1] * more1 + w.q[2] * more2) {}
  /// (Σ bᵢ aᵢ / Σ bᵢ)′ = (Σ bᵢ′ aᵢ − value Σ bᵢ′) / Σ bᵢ, all relative to corner 0.
  [[nodiscard]] RASTRUM_HD_LEAF Coordinate at(const CornerShares& shares) const {
    const float offset = shares.offset(d1, d2);
    return {a0 + offset, static_cast<float>((px - offset * p) * shares.scale),
            static_cast<float>((qy - offset * q) * shares.scale)};
  }
};

/// Linear light, or display values for the classic shader, at a triangle's corners, for a draw that
/// has colours.
RASTRUM_HD inline void shown_colors(const MaterialDraw& draw, const MaterialView& scene,
                                    const TrianglePlace& place, const std::uint32_t (&vertex)[3],
                                    Vec4 (&out)[3]) {
  draw.colors.corners(place, vertex, out);
  if ((draw.color_space == ColorSpace::display) == scene.classic) return;
  for (Vec4& c : out) c = scene.classic ? display_value(c) : linear_from_display(scene.curve, c);
}

struct MaterialTriangle {
  /// Set for copies alone, which share all but a matrix and a colour.
  union OwnDraw {
    MaterialDraw draw;
    RASTRUM_HD OwnDraw() {}
  } own;
  const MaterialDraw& draw;
  const MaterialView& scene;
  std::uint64_t index;  ///< in its mesh
  TrianglePlace place;
  std::uint32_t vertex[3];
  WeightPlanes planes;

  /// `d`: the draw of `frame` with primitive `id`.
  template <class Geometry>
  RASTRUM_HD MaterialTriangle(const MaterialView& of, const Geometry& frame, const Draw& d,
                              std::uint64_t id)
      : draw(draw_of(of.draws[d.number], d, id)),
        scene(of),
        index(d.of_copy(id - d.first_id).primitive),
        place(draw.mesh->place(index)) {
    d.vertices(id - d.first_id, vertex);
    planes = weight_planes(frame, d, vertex);
    if (d.is_copied())
      for (std::uint32_t& v : vertex) v %= d.copies.vertices;
  }
  MaterialTriangle(const MaterialTriangle&) = delete;
  MaterialTriangle& operator=(const MaterialTriangle&) = delete;

  template <class T>
  [[nodiscard]] RASTRUM_HD T corner(const AttributeView<T>& attribute, int c) const {
    return attribute.at(place, vertex, static_cast<std::size_t>(c));
  }
  /// At all three corners.
  template <class T>
  RASTRUM_HD void corners(const AttributeView<T>& attribute, T (&out)[3]) const {
    attribute.corners(place, vertex, out);
  }
  /// Requires that the draw has colours.
  RASTRUM_HD void colors(Vec4 (&out)[3]) const { shown_colors(draw, scene, place, vertex, out); }
  /// In world space. Requires that the mesh has normals.
  RASTRUM_HD void normals(Vec3 (&out)[3]) const {
    corners(draw.mesh->normals, out);
    fill_in_normals(*draw.mesh, vertex, out);
    for (Vec3& n : out) n = times(draw.normal_matrix, n);
  }
  /// From corner 0 to corner c; float64 positions are rounded once.
  [[nodiscard]] RASTRUM_HD Vec3 edge(int c) const {
    const ArrayView<Vec3>& positions = draw.mesh->positions;
    if (positions.is_wide()) {
      const Vec3d e = positions.wide(vertex[c]) - positions.wide(vertex[0]);
      // nvcc takes Vec3(e) for the members in parentheses.
      return {static_cast<float>(e.x), static_cast<float>(e.y), static_cast<float>(e.z)};
    }
    return positions[vertex[c]] - positions[vertex[0]];
  }
  /// The plane's unit normal in world space; 0 without area.
  [[nodiscard]] RASTRUM_HD Vec3 face_normal() const {
    return normalize(times(draw.normal_matrix, cross(edge(1), edge(2))));
  }

 private:
  RASTRUM_HD const MaterialDraw& draw_of(const MaterialDraw& shared, const Draw& d,
                                         std::uint64_t id) {
#if !defined(__CUDA_ARCH__)
    if (d.is_copied()) return own.draw = shared.of(shared.copies[d.of_copy(id - d.first_id).copy]);
#endif
    return shared;
  }
};

/// Whether a face with this normal is seen from behind at image point `px`. Each fragment decides
/// by itself, so that its colour depends on no other.
RASTRUM_HD_LEAF bool is_seen_from_behind(const ViewRays& rays, Vec3 face, float px, float py) {
  return dot(face, rays.d + rays.dx * px + rays.dy * py) > 0;
}

/// An interpolated normal, normalized and turned to the visible side of the face (`side`: −1 from
/// behind, else 1). Without length: the face's.
RASTRUM_HD_LEAF Vec3 turned(Vec3 n, Vec3 face, float side) {
  const float square = n.x * n.x + n.y * n.y + n.z * n.z;
  const float scale = 1 / std::sqrt(square);
  const bool has = square > 0;
  const Vec3 seen{face.x * side, face.y * side, face.z * side};
  const float x = has ? n.x * scale : seen.x;
  const float y = has ? n.y * scale : seen.y;
  const float z = has ? n.z * scale : seen.z;
  const float turn = x * seen.x + y * seen.y + z * seen.z < 0 ? -1.0F : 1.0F;
  return {x * turn, y * turn, z * turn};
}

/// The directions of a texture's right and up in world space; (0, 0, 0) where the coordinates span
/// nothing.
struct TangentFrame {
  Vec3 right{}, up{};

  RASTRUM_HD explicit TangentFrame(const MaterialTriangle& t) {
    const MeshView& mesh = *t.draw.mesh;
    if (mesh.texcoords.values.empty()) return;
    const Vec3 e1 = times(t.draw.to_world, t.edge(1));
    const Vec3 e2 = times(t.draw.to_world, t.edge(2));
    const Vec2 a = t.corner(mesh.texcoords, 0);
    const Vec2 d1 = t.corner(mesh.texcoords, 1) - a, d2 = t.corner(mesh.texcoords, 2) - a;
    const float sign = d1.x * d2.y - d2.x * d1.y < 0 ? -1.0F : 1.0F;
    right = normalize((e1 * d2.y - e2 * d1.y) * sign);
    up = normalize((e1 * d2.x - e2 * d1.x) * sign);  // −∂P/∂v
  }
  [[nodiscard]] RASTRUM_HD_LEAF Vec3 bend(Vec3 n, float r, float g, float b, float strength) const {
    const float x = (r * 2 - 1) * strength;
    const float y = (g * 2 - 1) * strength;
    const float z = b * 2 - 1;
    const Vec3 across = right - n * dot(n, right);
    const Vec3 along = up - n * dot(n, up);
    const Vec3 bent = n * z + normalize(across) * x + normalize(along) * y;
    const float square = dot(bent, bent);
    const float scale = 1 / std::sqrt(square);
    return square > 0 ? bent * scale : n;
  }
};

/// NaN gives 0.
RASTRUM_HD_LEAF float clamped_alpha(float a) {
  return a > 0 ? (a < 1 ? a : 1.0F) : 0.0F;
}

/// Whether all fragments have their material's alpha.
RASTRUM_HD inline bool has_constant_alpha(const MaterialDraw& draw, const BoundMaterial& material) {
  return draw.colors.empty() && material.base_color == nullptr && material.alpha == nullptr;
}

}  // namespace rastrum::raster
