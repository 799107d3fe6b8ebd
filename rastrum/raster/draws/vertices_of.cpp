// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/draws/vertices_of.hpp>

namespace rastrum::raster {

VertexList vertices_of(GeometryRef geometry) {
  if (const auto* const mesh = geometry.get_if<MeshView>()) return {&mesh->positions};
  if (const auto* const points = geometry.get_if<PointsView>())
    return {&points->positions, Topology::points};
  if (const auto* const lines = geometry.get_if<LinesView>())
    return {&lines->positions, Topology::lines};
  return {};
}

bool set_vertices(Draw& draw, GeometryRef geometry, const Mat4d& object_to_clip) {
  const VertexList vertices = vertices_of(geometry);
  if (vertices.positions == nullptr) return false;
  if (const auto* const mesh = geometry.get_if<MeshView>()) draw.set_triangles(*mesh);
  if (const auto* const points = geometry.get_if<PointsView>()) draw.set_points(*points);
  if (const auto* const lines = geometry.get_if<LinesView>()) draw.set_lines(*lines);
  draw.source = MatrixVertices(*vertices.positions, object_to_clip);
  return true;
}

void set_copies(Draw& draw, const MeshView& mesh, const InstanceView* instances, std::size_t count,
                const Mat4d& world_to_clip) {
  draw.set_triangles(mesh, count);
  draw.source = CopiedVertices{mesh.positions, &instances->object_to_world, sizeof(InstanceView),
                               world_to_clip};
}

}  // namespace rastrum::raster
