// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/mesh.hpp>
#include <rastrum/scene/face_cuts.hpp>
#include <rastrum/scene/mesh_checks.hpp>

#include <algorithm>
#include <list>
#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>

namespace rastrum {
namespace {

/// An edge's smaller and larger index, and its place.
using Edge = std::pair<std::uint64_t, std::uint64_t>;

void add_line(std::vector<Vec3>& lines, Vec3 from, Vec3 normal, float length) {
  const Vec3 n = normalize(normal);
  if (!is_finite(n) || !(dot(n, n) > 0)) return;
  lines.push_back(from);
  lines.push_back(from + n * length);
}

}  // namespace

std::vector<std::uint32_t> edge_indices(const MeshView& given) {
  std::list<FaceCuts> cuts;
  const MeshView mesh = with_cuts(given, cuts);
  const std::size_t triangles = mesh.triangle_count();
  std::vector<Edge> edges(triangles * 3);
  for (std::size_t t = 0; t < triangles; ++t) {
    std::uint32_t vertex[3];
    mesh.read_triangles(t, 1, vertex);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint64_t a = vertex[c], b = vertex[(c + 1) % 3];
      edges[3 * t + c] = {std::min(a, b) << 32 | std::max(a, b), 3 * t + c};
    }
  }
  std::ranges::sort(edges);
  // Clang 14 does not compile the subrange that std::ranges::unique returns.
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const Edge& a, const Edge& b) { return a.first == b.first; }),
              edges.end());
  std::ranges::sort(edges, {}, &Edge::second);
  std::vector<std::uint32_t> pairs;
  pairs.reserve(edges.size() * 2);
  for (const auto& [key, place] : edges) {
    pairs.push_back(static_cast<std::uint32_t>(key >> 32));
    pairs.push_back(static_cast<std::uint32_t>(key));
  }
  return pairs;
}

std::vector<Vec3> normal_lines(const MeshView& given, float length) {
  const FloatScope floats;
  std::vector<Vec3> lines;
  const auto at = [](const auto& values, std::size_t i) {
    if (i >= values.size())
      throw Error(Errc::invalid_argument, "normal_lines: an index is out of range");
    return values[i];
  };
  if (const std::string problem = faces_problem(given); !problem.empty())
    throw Error(Errc::invalid_argument, "normal_lines: " + problem);
  std::list<FaceCuts> cuts;
  const MeshView mesh = with_cuts(given, cuts);
  if (!mesh.normals.empty() && mesh.normals.indices.empty() && mesh.normals.per == Per::vertex) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      add_line(lines, mesh.positions[i], at(mesh.normals.values, i), length);
    return lines;
  }
  const std::size_t triangles = mesh.triangle_count();
  for (std::size_t t = 0; t < triangles; ++t) {
    const TrianglePlace place = mesh.place(t);
    std::uint32_t vertex[3];
    Vec3 p[3];
    for (std::size_t i = 0; i < 3; ++i) {
      vertex[i] = mesh.vertex(place.corner[i]);
      p[i] = at(mesh.positions, vertex[i]);
    }
    if (mesh.normals.empty()) {
      add_line(lines, (p[0] + p[1] + p[2]) * (1.0F / 3), cross(p[1] - p[0], p[2] - p[0]), length);
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i)
      add_line(lines, p[i], at(mesh.normals.values, mesh.normals.element(place, vertex, i)),
               length);
  }
  return lines;
}

}  // namespace rastrum
