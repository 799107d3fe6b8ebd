#include <rastrum/raster/draws/vertices_of.hpp>

#include <variant>

namespace rastrum::raster {

bool set_vertices(Draw& draw, const GeometryView& geometry, const Mat4d& object_to_clip) {
  const auto* const mesh = std::get_if<MeshView>(&geometry);
  const auto* const points = std::get_if<PointsView>(&geometry);
  const auto* const lines = std::get_if<LinesView>(&geometry);
  if (mesh != nullptr) draw.set_triangles(*mesh);
  if (points != nullptr) draw.set_points(*points);
  if (lines != nullptr) draw.set_lines(*lines);
  if (mesh == nullptr && points == nullptr && lines == nullptr) return false;
  draw.source = MatrixVertices(mesh != nullptr     ? mesh->positions
                               : points != nullptr ? points->positions
                                                   : lines->positions,
                               object_to_clip);
  return true;
}

}  // namespace rastrum::raster
