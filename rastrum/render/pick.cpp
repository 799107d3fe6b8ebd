// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/pick.hpp>

#include <algorithm>
#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>
#include <rastrum/render/surface_of_key.hpp>
#include <rastrum/render/surfaces.hpp>

namespace rastrum {
namespace {

const InstanceView& instance_of(const SceneView& scene, const Located& at) {
  if (at.instance >= scene.instances.size())
    reject("instance ", at.instance, " is out of range, the scene has ", scene.instances.size());
  const InstanceView& instance = scene.instances[at.instance];
  if (const std::uint64_t count = primitive_count(instance.geometry); at.primitive >= count)
    reject("instance ", at.instance, ": primitive ", at.primitive, " is out of range, there are ",
           count);
  return instance;
}

[[noreturn]] void refuse_index(const Located& at, const char* of) {
  reject("instance ", at.instance, ": an index of ", of, " ", at.primitive, " is out of range");
}

/// Throws if they are out of range.
raster::AxisEnds ends_of(const Located& at, const raster::QuadricGeometry& geometry) {
  const raster::AxisEnds ends = raster::axis_ends(geometry, at.primitive);
  if (std::max(ends.first, ends.second) >= raster::positions_of(geometry).size())
    refuse_index(at, "primitive");
  return ends;
}

/// Makes `draw` that of the instance, which has vertices. Throws if the primitive's are out of
/// range.
void set_vertices_of(raster::Draw& draw, const Located& at, const InstanceView& instance,
                     const Mat4d& to_clip) {
  raster::set_vertices(draw, instance.geometry, to_clip);
  for (int c = 0; c < static_cast<int>(draw.topology); ++c)
    if (draw.vertex(at.primitive, c) >= draw.vertex_count)
      refuse_index(at, instance.mesh() != nullptr ? "triangle" : "primitive");
}

/// One instance as a scene of its own, so that questions about a primitive cost nothing for others.
struct Alone {
  Located at;
  InstanceView instance;
  SceneView scene;
  std::optional<raster::QuadricStage> quadrics;
  raster::Draw draw;
  raster::FrameGeometry geometry;

  Alone(const SceneView& all, const Camera& camera, int width, int height, std::uint64_t id)
      : at(locate(all, id)), instance(all.instances[at.instance]), scene{{&instance, 1}, {}, {}} {
    const Mat4d to_clip = world_to_clip(camera, width, height) * instance.object_to_world;
    draw.winding = winding_of(instance);
    draw.first_id = id - at.primitive;
    geometry = {width, height, raster::Viewport::of(width, height), {&draw, 1}, nullptr};
    if (const auto surfaces = quadrics_of(instance.geometry)) {
      (void)ends_of(at, *surfaces);
      draw.quadrics = &quadrics.emplace(*surfaces, to_clip);
      return;
    }
    set_vertices_of(draw, at, instance, to_clip);
  }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;
};

Barycentrics weights_of(const Fragment& f) {
  return {{f.weights.b[0], f.weights.b[1], f.weights.b[2]}};
}

/// On the nearer side of a quadric that covers the pixel's centre: front, else back.
Barycentrics weights_of_quadric(const Alone& alone, int x, int y) {
  raster::QuadricSurface s;
  if (!s.find(*alone.quadrics, alone.at.primitive, alone.geometry.viewport)) return {};
  const raster::QuadricSurface::Place centre = s.at(x, y);
  raster::scalar_wide::Surface side = s.side(false, centre);
  if (!side.covered) side = s.side(true, centre);
  if (!side.covered) return {};
  const double along = raster::point_on(s.shape, s.point(centre, side.e)).along;
  return {{1 - along, along, 0}};
}

}  // namespace

Located locate(const SceneView& scene, std::uint64_t id) {
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint64_t count = primitive_count(scene.instances[i].geometry);
    if (id - first < count) return {i, id - first};
    first += count;
  }
  reject("primitive ", id, " is out of range, the scene has ", first);
}

Barycentrics barycentrics(const SceneView& scene, const Camera& camera, int width, int height,
                          std::uint64_t id, int x, int y) {
  const FloatScope floats;
  check_image_size(width, height);
  const Alone alone(scene, camera, width, height, id);
  if (alone.quadrics) return weights_of_quadric(alone, x, y);
  return weights_of(raster::FragmentLocator(alone.geometry).locate(id, x, y, 0, nullptr));
}

Vec3d position(const SceneView& scene, const Located& at, const Barycentrics& where) {
  const FloatScope floats;
  const InstanceView& instance = instance_of(scene, at);
  if (const auto surfaces = quadrics_of(instance.geometry)) {
    const raster::AxisEnds ends = ends_of(at, *surfaces);
    const ArrayView<Vec3>& p = raster::positions_of(*surfaces);
    return raster::in_world(
        instance, p.wide(ends.first) * where.weight[0] + p.wide(ends.second) * where.weight[1]);
  }
  raster::Draw draw;
  set_vertices_of(draw, at, instance, Mat4d::identity());
  Fragment f;
  for (int c = 0; c < static_cast<int>(draw.topology); ++c) {
    f.vertex[c] = draw.vertex(at.primitive, c);
    f.weights.b[c] = where.weight[c];
  }
  return raster::position_on(instance, f);
}

Pick surface_of_key(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    std::uint64_t key, int x, int y) {
  const std::uint64_t id = raster::id_of_key(key);
  const int width = frame.width, height = frame.height;
  const Alone alone(scene, camera, width, height, id);
  raster::SurfaceLocator locator(alone.geometry, frame.samples);
  const raster::SeenFragment& f = locator.locate(key, x, y, 0);
  raster::SurfaceScene surface(alone.scene, nullptr, camera, width, height);
  const raster::SurfaceScalars scalars(alone.instance, nullptr);
  surface.scalars = {&scalars, 1};
  Pick pick;
  pick.id = id;
  pick.instance = alone.at.instance;
  pick.instance_id = alone.instance.id.value_or(static_cast<std::int64_t>(alone.at.instance));
  pick.primitive = alone.at.primitive;
  pick.barycentrics = weights_of(f);
  pick.position = surface.position(f);
  raster::LitTriangle kept{};
  pick.normal = surface.normal(alone.geometry, f, kept);
  if (!scalars.empty()) pick.scalar = surface.scalar(alone.geometry, f);
  pick.depth = f.depth;
  pick.view_depth = view_distance(camera, pick.depth);
  pick.distance = pick.view_depth * surface.ray_length(x, y);
  return pick;
}

bool is_seen(const ProjectedPoint& point, ImageView<const float> view_depth) {
  if (!(point.view_depth > 0 && point.x >= 0 && point.x < view_depth.width && point.y >= 0 &&
        point.y < view_depth.height))
    return false;
  const int x = static_cast<int>(point.x), y = static_cast<int>(point.y);
  double farthest[5] = {};  // and the next; the last is the middle of nine
  for (int j = std::max(y - 1, 0); j < std::min(y + 2, view_depth.height); ++j)
    for (int i = std::max(x - 1, 0); i < std::min(x + 2, view_depth.width); ++i) {
      auto depth = static_cast<double>(view_depth(i, j));
      if (!(depth > 0)) return true;
      for (double& far : farthest)
        if (depth > far) std::swap(depth, far);
    }
  // In an inner corner the point itself is the farthest, by less than a pixel's slope.
  double slope = 0;
  for (const double far : farthest)
    if (far > 0) slope = farthest[0] - far;
  return point.view_depth <= std::max(farthest[0] * (1 + 1e-4), farthest[0] + slope);
}

}  // namespace rastrum
