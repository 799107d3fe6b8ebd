// SPDX-License-Identifier: BSD-3-Clause
// Properties of meshes by their definitions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/mesh.hpp>

namespace rastrum::test {

inline std::uint32_t position_index(const Mesh& mesh, std::size_t corner) {
  return mesh.indices.empty() ? static_cast<std::uint32_t>(corner) : mesh.indices[corner];
}

template <class T>
T attribute_at(const Mesh& mesh, const Attribute<T>& attribute, std::size_t corner) {
  return attribute
      .values[attribute.indices.empty() ? position_index(mesh, corner) : attribute.indices[corner]];
}

inline Vec3 position_at(const Mesh& mesh, std::size_t corner) {
  return mesh.positions[position_index(mesh, corner)];
}

struct EdgeUse {
  int forward = 0, backward = 0;  ///< uses from the smaller index on, and back
};
using EdgeUses = std::map<std::pair<std::uint32_t, std::uint32_t>, EdgeUse>;

inline EdgeUses edge_uses(const Mesh& mesh) {
  EdgeUses uses;
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const std::uint32_t a = position_index(mesh, corner);
    const std::uint32_t b = position_index(mesh, corner % 3 == 2 ? corner - 2 : corner + 1);
    EdgeUse& use = uses[std::minmax(a, b)];
    ++(a < b ? use.forward : use.backward);
  }
  return uses;
}

/// Whether every edge has two triangles, which use it in opposite directions.
inline bool is_closed_and_oriented(const Mesh& mesh) {
  for (const auto& [edge, use] : edge_uses(mesh))
    if (use.forward != 1 || use.backward != 1 || edge.first == edge.second) return false;
  return mesh.triangle_count() > 0;
}

inline Vec3 face_normal(const Mesh& mesh, std::size_t triangle) {
  const Vec3 a = position_at(mesh, 3 * triangle);
  return cross(position_at(mesh, 3 * triangle + 1) - a, position_at(mesh, 3 * triangle + 2) - a);
}

/// Positive if a closed mesh faces outward.
inline double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    volume += static_cast<double>(dot(position_at(mesh, 3 * t), face_normal(mesh, t))) / 6;
  return volume;
}

inline double area(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    sum += static_cast<double>(length(face_normal(mesh, t))) / 2;
  return sum;
}

struct Box {
  Vec3 min{INFINITY, INFINITY, INFINITY}, max{-INFINITY, -INFINITY, -INFINITY};
};
inline Box box_of(const Mesh& mesh) {
  Box box;
  for (const Vec3 p : mesh.positions) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  return box;
}

/// Expects that texture coordinates differ by at most `steps` within a triangle, also at a seam.
inline void expect_no_seam(const Mesh& mesh, Vec2 steps) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec2 d = attribute_at(mesh, mesh.texcoords, 3 * t + c) -
                     attribute_at(mesh, mesh.texcoords, 3 * t + (c + 1) % 3);
      EXPECT_LE(std::abs(d.x), 1.001F / steps.x);
      EXPECT_LE(std::abs(d.y), 1.001F / steps.y);
    }
}

}  // namespace rastrum::test
