// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/effects.hpp>

#include <algorithm>
#include <bit>
#include <list>
#include <vector>

#include <rastrum/core/angle.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/shares.hpp>
#include <rastrum/parallel/sort_by_key.hpp>
#include <rastrum/scene/face_cuts.hpp>
#include <rastrum/scene/weld.hpp>

namespace rastrum {
namespace {

/// A side of a triangle: 3 · triangle + side, and whether it goes from the larger of its two points
/// to the smaller.
struct Side {
  std::uint64_t place_and_turned;
  [[nodiscard]] std::uint64_t place() const { return place_and_turned >> 1; }
  [[nodiscard]] bool turned() const { return (place_and_turned & 1) != 0; }
};

template <class Exec>
std::vector<std::uint8_t> sides_on(Exec& exec, const MeshView& mesh, double angle_degrees,
                                   bool cuts_faces) {
  const std::size_t triangles = mesh.triangle_count();
  const JoinedPoints points =
      weld(exec, mesh.positions.size(), [&](std::uint32_t v) { return mesh.positions.wide(v); });
  // By the points at its ends, the smaller first. Sides of degenerate triangles come last.
  std::vector<std::uint64_t> ends(3 * triangles);
  std::vector<Side> sides(3 * triangles);
  const std::uint64_t none = std::uint64_t{points.count} << 32;
  std::vector<Vec3d> normals(triangles);  // twice the area long
  parallel::for_each_block(exec, triangles, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      std::uint32_t vertex[3];
      mesh.read_triangles(t, 1, vertex);
      const Vec3d a = mesh.positions.wide(vertex[0]);
      normals[t] = cross(mesh.positions.wide(vertex[1]) - a, mesh.positions.wide(vertex[2]) - a);
      std::uint64_t point[3];
      for (std::size_t c = 0; c < 3; ++c) point[c] = points.of_vertex[vertex[c]];
      // Two corners coincide: a line, which bounds no faces.
      const bool is_line = point[0] == point[1] || point[1] == point[2] || point[2] == point[0];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint64_t from = point[c], to = point[(c + 1) % 3];
        ends[3 * t + c] = is_line ? none : std::min(from, to) << 32 | std::max(from, to);
        sides[3 * t + c] = {(3 * t + c) << 1 | static_cast<std::uint64_t>(from > to)};
      }
    }
  });
  parallel::sort_by_key(exec, ends, sides, static_cast<int>(std::bit_width(none)));
  const auto behind =
      static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end(), none) - ends.begin());
  const double cosine = sin_cos_degrees(angle_degrees).cos;
  const auto is_edge = [&](const Side& a, const Side& b) {
    const std::size_t t = a.place() / 3, u = b.place() / 3;
    if (cuts_faces && mesh.place(t).face == mesh.place(u).face) return false;
    if (angle_degrees == 0) return true;
    // Neighbours of the same winding traverse their common side in opposite directions.
    const double sign = a.turned() == b.turned() ? -1 : 1;
    return !(sign * dot(normals[t], normals[u]) >=
             cosine * (length(normals[t]) * length(normals[u])));
  };
  std::vector<std::uint8_t> drawn(triangles);
  for (std::size_t i = 0, end = 0; i < behind; i = end) {
    while (end < behind && ends[end] == ends[i]) ++end;
    // A side of one triangle, or of more than two, is always an edge.
    if (end - i == 2 && !is_edge(sides[i], sides[i + 1])) continue;
    for (std::size_t k = i; k < end; ++k)
      drawn[sides[k].place() / 3] |= static_cast<std::uint8_t>(1U << sides[k].place() % 3);
  }
  return drawn;
}

std::vector<std::uint8_t> sides_of(const MeshView& given, double angle_degrees) {
  check_indices(given);
  std::list<FaceCuts> cuts;
  const MeshView mesh = with_cuts(given, cuts);
  const bool cuts_faces =
      mesh.faces.kind == FaceKind::quads || mesh.faces.kind == FaceKind::polygons;
  if (angle_degrees == 0 && !cuts_faces) return {};
  return parallel::on_threads_of_its_own(mesh.triangle_count(), [&](auto& exec) {
    return sides_on(exec, mesh, angle_degrees, cuts_faces);
  });
}

bool is_same(const MeshView& a, const MeshView& b) {
  return a.positions == b.positions && a.indices == b.indices && a.faces == b.faces;
}

}  // namespace

SceneEdges::SceneEdges(const SceneView& scene, double angle_degrees) : scene_(scene) {
  const FloatScope floats;
  if (!(angle_degrees >= 0 && angle_degrees <= 180))
    reject("SceneEdges: the angle must lie in [0, 180], got ", angle_degrees);
  std::uint64_t next = 0;
  const MeshView* last = nullptr;
  for (const InstanceView& instance : scene.instances) {
    first_ids_.push_back(next);
    next += primitive_count(instance.geometry);
    const MeshView* const mesh = instance.mesh();
    // Instances of one mesh mostly follow each other.
    if (mesh != nullptr && (last == nullptr || !is_same(*mesh, *last))) {
      tables_.push_back(sides_of(*mesh, angle_degrees));
      last = mesh;
    }
    table_of_.push_back(tables_.empty() ? 0 : tables_.size() - 1);
  }
  first_ids_.push_back(next);
}

SceneEdges::Place SceneEdges::find(std::int64_t id) const {
  const auto number = static_cast<std::uint64_t>(id);
  const std::uint64_t all = first_ids_.empty() ? 0 : first_ids_.back();
  if (id < 0 || number >= all)
    reject("SceneEdges: primitive ", id, " is out of range, the scene has ", all);
  const auto after = std::upper_bound(first_ids_.begin(), first_ids_.end(), number);
  const auto instance = static_cast<std::size_t>(after - first_ids_.begin()) - 1;
  return {instance, number - first_ids_[instance]};
}

std::uint8_t SceneEdges::sides(const Place& place) const {
  if (place.instance >= table_of_.size() ||
      place.primitive >= first_ids_[place.instance + 1] - first_ids_[place.instance])
    reject("SceneEdges: primitive ", place.primitive, " of instance ", place.instance,
           " is out of range, the scene does not have it");
  if (scene_.instances[place.instance].mesh() == nullptr) return 0;
  const std::vector<std::uint8_t>& drawn = tables_[table_of_[place.instance]];
  return drawn.empty() ? 7 : drawn[static_cast<std::size_t>(place.primitive)];
}

}  // namespace rastrum
