// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/resolve/surface_point.hpp>

#include <bit>
#include <cmath>
#include <limits>

#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_scalar.hpp>
#include <rastrum/raster/shade/normals.hpp>
#include <rastrum/raster/shade/quadric_shader.hpp>

namespace rastrum::raster {
const SeenFragment& SurfaceLocator::locate(std::uint64_t key, int x0, int y0, int i) {
  const std::uint64_t id = id_of_key(key);
  if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count)
    draw_ = &frame_.draw_of(id);
  const Draw& draw = *draw_;
  seen_.depth = std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits));
  if (draw.quadrics == nullptr) {
    Fragment& f = locator_.locate(id, x0, y0, i, nullptr, changes_);
    f.depth = seen_.depth;
    static_cast<Fragment&>(seen_) = f;
    seen_.copy = draw.of_copy(id - draw.first_id).copy;
    seen_.cut = samples_ > 1;
    seen_.quadric = nullptr;
    return seen_;
  }
  seen_.id = id;
  locate_quadric(draw, x0 + i % kBlockSize, y0 + i / kBlockSize);
  return seen_;
}

void SurfaceLocator::locate_quadric(const Draw& draw, int x, int y) {
  seen_.x = x;
  seen_.y = y;
  seen_.triangle = seen_.id - draw.first_id;
  seen_.copy = 0;
  seen_.draw = static_cast<std::size_t>(&draw - frame_.draws.data());
  if (seen_.id != quadric_id_) {
    (void)surface_.find(*draw.quadrics, seen_.triangle, frame_.viewport);
    quadric_id_ = seen_.id;
  }
  hit_ = seen_of(surface_, x, y, seen_.depth, samples_, changes_);
  seen_.weights = {};
  seen_.weights.b[0] = 1 - hit_.point.along;
  seen_.weights.b[1] = hit_.point.along;
  seen_.quadric = &hit_;
}

Vec3d position_on(const InstanceView& instance, const Fragment& f) {
  const VertexList vertices = vertices_of(instance.geometry);
  Vec3d p;
  for (int c = 0; c < static_cast<int>(vertices.topology); ++c) {
    const Vec3d part = vertices.positions->wide(f.vertex[c]) * f.weights.b[c];
    p = c == 0 ? part : p + part;
  }
  return in_world(instance, p);
}

Vec3d in_world(const InstanceView& instance, Vec3d p) {
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

SurfaceScene::SurfaceScene(const SceneView& s, const InstanceRuns* r, const Camera& c, int width,
                           int height)
    : scene(s), runs(r), camera(c), lit(s, c, width, height), to_camera(world_to_camera(c)) {
  lit.by_place = true;
  lit.colored = false;  // nothing here asks for colours
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) camera_rows[i][j] = static_cast<float>(to_camera.m[i][j]);
  for (std::size_t i = 0; i < lit.draws.size(); ++i) {
    only_meshes &= lit.draws[i].mesh != nullptr;
    if (runs != nullptr) lit.draws[i].copies = runs->instances(i);
  }
}

Vec3d SurfaceScene::object_normal(const SeenFragment& f) const {
  if (f.quadric != nullptr) return f.quadric->point.normal;
  const auto* const points = scene.instances[f.draw].geometry.get_if<PointsView>();
  if (points == nullptr || points->normals.empty()) return {};
  return safe_normal(points->normals[f.vertex[0]]);
}

Vec3 SurfaceScene::normal(const FrameGeometry& frame, const SeenFragment& f,
                          LitTriangle& kept) const {
  const LitDraw& draw = lit.draws[f.draw];
  if (draw.mesh != nullptr) {
    if (kept.low != kIdMask - f.id) fetch_triangle(lit, frame, kIdMask - f.id, true, kept);
    return seen_normal(lit.rays, kept, f.x, f.y, f.cut);
  }
  const Vec3d n = object_normal(f);
  const auto row = [&](int i) {
    const auto& m = draw.normal_matrix;
    return (double{m[i][0]} * n.x + double{m[i][1]} * n.y) + double{m[i][2]} * n.z;
  };
  const Vec3d world{row(0), row(1), row(2)};
  const double l = length(world);
  if (!(l > 0) || !std::isfinite(l)) return {};
  const double scale = dot(world, to_viewer(f.x, f.y)) < 0 ? -1 : 1;
  return Vec3(Vec3d{world.x / l * scale, world.y / l * scale, world.z / l * scale});
}

Vec3 SurfaceScene::in_camera(Vec3 d) const {
  return scalar_lane::turned(camera_rows, d);
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

double SurfaceScene::scalar(const FrameGeometry& frame, const SeenFragment& f) const {
  if (scalars.empty() || scalars[f.draw].empty()) return std::numeric_limits<double>::quiet_NaN();
  if (f.quadric == nullptr) return scalars[f.draw].at(f, frame.draws[f.draw].topology);
  double ends[2];
  scalars_at_ends(frame, f, ends);
  return SurfaceScalars::between(ends, f.quadric->point.along);
}

void SurfaceScene::scalars_at_ends(const FrameGeometry& frame, const SeenFragment& f,
                                   double (&ends)[2]) const {
  const QuadricStage& stage = *frame.draws[f.draw].quadrics;
  scalars[f.draw].at_ends(axis_ends(stage.geometry(), f.triangle), ends);
}

Vec4 SurfaceScene::albedo(const FrameGeometry& frame, const SeenFragment& f) const {
  const InstanceView& instance = scene.instances[f.draw];
  if (!scalars.empty() && scalars[f.draw].colors() != nullptr) {
    if (f.quadric == nullptr) return scalars[f.draw].color(f, frame.draws[f.draw].topology, true);
    double ends[2];
    scalars_at_ends(frame, f, ends);
    return scalars[f.draw].color(ends, f.quadric->point.along, f.quadric->along_per_px, true);
  }
  if (f.quadric != nullptr) {
    const QuadricGeometry& geometry = frame.draws[f.draw].quadrics->geometry();
    return albedo_at(geometry, instance, scene.materials, f.triangle, f.quadric->point.along);
  }
  if (is_points_or_lines(instance.geometry)) return points_and_lines->albedo(frame, f);
  return material_albedo(materials->view(), frame, f);
}

}  // namespace rastrum::raster
