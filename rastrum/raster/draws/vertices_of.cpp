#include <rastrum/raster/draws/vertices_of.hpp>

#include <variant>

namespace rastrum::raster {

VertexList vertices_of(const GeometryView& geometry) {
  if (const auto* const mesh = std::get_if<MeshView>(&geometry)) return {&mesh->positions};
  if (const auto* const points = std::get_if<PointsView>(&geometry))
    return {&points->positions, Topology::points};
  if (const auto* const lines = std::get_if<LinesView>(&geometry))
    return {&lines->positions, Topology::lines};
  return {};
}

bool set_vertices(Draw& draw, const GeometryView& geometry, const Mat4d& object_to_clip) {
  const VertexList vertices = vertices_of(geometry);
  if (vertices.positions == nullptr) return false;
  if (const auto* const mesh = std::get_if<MeshView>(&geometry)) draw.set_triangles(*mesh);
  if (const auto* const points = std::get_if<PointsView>(&geometry)) draw.set_points(*points);
  if (const auto* const lines = std::get_if<LinesView>(&geometry)) draw.set_lines(*lines);
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
