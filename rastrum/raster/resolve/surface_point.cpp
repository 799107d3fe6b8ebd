#include <rastrum/raster/resolve/surface_point.hpp>

#include <cmath>

#include <rastrum/raster/shade/material_scalar.hpp>
#include <rastrum/raster/shade/normals.hpp>

namespace rastrum::raster {
namespace {

/// Σ bᵢ vᵢ, left to right.
Vec3d interpolate(const Fragment& f, const Vec3d (&v)[3]) {
  const double(&b)[3] = f.weights.b;
  return v[0] * b[0] + v[1] * b[1] + v[2] * b[2];
}

/// The positions of a geometry, and how many of them a primitive has.
struct CornerPositions {
  const ArrayView<Vec3>* positions;
  int count;
};
CornerPositions corner_positions(const GeometryView& geometry) {
  if (const auto* const points = std::get_if<PointsView>(&geometry)) return {&points->positions, 1};
  if (const auto* const lines = std::get_if<LinesView>(&geometry)) return {&lines->positions, 2};
  return {&std::get<MeshView>(geometry).positions, 3};
}

}  // namespace

Vec3d position_on(const InstanceView& instance, const Fragment& f) {
  const CornerPositions corners = corner_positions(instance.geometry);
  Vec3d p;
  for (int c = 0; c < corners.count; ++c) {
    const Vec3d part = corners.positions->wide(f.vertex[c]) * f.weights.b[c];
    p = c == 0 ? part : p + part;
  }
  const auto& m = instance.object_to_world.m;
  const auto row = [&](int i) {
    return ((m[i][0] * p.x + m[i][1] * p.y) + m[i][2] * p.z) + m[i][3];
  };
  return {row(0), row(1), row(2)};
}

Vec3d SurfaceScene::to_viewer(int x, int y) const {
  const ViewRays& r = lit.rays;
  return -(Vec3d(r.d) + Vec3d(r.dx) * (x + 0.5) + Vec3d(r.dy) * (y + 0.5));
}

Vec3d SurfaceScene::normal(const Fragment& f) const {
  const LitDraw& draw = lit.draws[f.draw];
  Vec3d n;
  if (const auto* const points = std::get_if<PointsView>(&scene.instances[f.draw].geometry)) {
    if (!points->normals.empty()) n = Vec3d(safe_normal(points->normals[f.vertex[0]]));
  } else if (draw.mesh != nullptr) {
    Vec3 corners[3];
    corner_normals(*draw.mesh, draw.mesh->place(f.triangle), f.vertex, corners);
    n = interpolate(f, {corners[0], corners[1], corners[2]});
  }
  const auto& m = draw.normal_matrix;
  const auto row = [&](int i) {
    return (double{m[i][0]} * n.x + double{m[i][1]} * n.y) + double{m[i][2]} * n.z;
  };
  const Vec3d world{row(0), row(1), row(2)};
  const double l = length(world);
  if (!(l > 0) || !std::isfinite(l)) return {};
  const double scale = dot(world, to_viewer(f.x, f.y)) < 0 ? -1 : 1;
  return {world.x / l * scale, world.y / l * scale, world.z / l * scale};
}

Vec3d SurfaceScene::in_camera(Vec3d d) const {
  const auto& m = to_camera.m;
  const auto row = [&](int i) { return m[i][0] * d.x + m[i][1] * d.y + m[i][2] * d.z; };
  return {row(0), row(1), row(2)};
}

double SurfaceScene::ray_length(int x, int y) const {
  const Vec3d ray = to_viewer(x, y);
  return length(ray) / in_camera(ray).z;
}

Vec4 SurfaceScene::albedo(const FrameGeometry& frame, const Fragment& f) const {
  const GeometryView& geometry = scene.instances[f.draw].geometry;
  return std::holds_alternative<MeshView>(geometry) ? material_albedo(materials->view(), frame, f)
                                                    : points_and_lines->albedo(frame, f);
}

}  // namespace rastrum::raster
