#include <rastrum/pick.hpp>

#include <bit>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>
#include <rastrum/render/surface_of_key.hpp>

namespace rastrum {
namespace {

/// The draw of the instance that holds a primitive.
raster::Draw draw_of(const SceneView& scene, const Located& at, const Mat4d& world_to_clip) {
  const InstanceView& instance = scene.instances[at.instance];
  raster::Draw draw;
  if (!raster::set_vertices(draw, instance.geometry, world_to_clip * instance.object_to_world))
    throw Error(Errc::unsupported,
                "instance " + std::to_string(at.instance) +
                    " is no mesh, points or lines: only of those it is known what lies where");
  const auto corners = static_cast<int>(draw.topology);
  for (int c = 0; c < corners; ++c)
    if (draw.vertex(at.primitive, c) >= draw.vertex_count)
      throw Error(Errc::invalid_argument, "instance " + std::to_string(at.instance) +
                                              ": an index of primitive " +
                                              std::to_string(at.primitive) + " is out of range");
  return draw;
}

/// One instance as a scene of its own, so that what is asked about a primitive costs nothing for
/// the others.
struct Alone {
  Located at;
  InstanceView instance;
  SceneView scene;
  raster::Draw draw;
  raster::FrameGeometry geometry;

  Alone(const SceneView& all, const Camera& camera, int width, int height, std::uint64_t id)
      : at(locate(all, id)),
        instance(all.instances[at.instance]),
        scene{{&instance, 1}, {}, {}},
        draw(draw_of(all, at, world_to_clip(camera, width, height))) {
    draw.winding = instance.winding;
    draw.first_id = id - at.primitive;
    geometry = {width, height, raster::Viewport::of(width, height), {&draw, 1}, nullptr};
  }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

  [[nodiscard]] raster::Fragment fragment(std::uint64_t id, int x, int y) const {
    return raster::FragmentLocator(geometry).locate(id, x, y, 0, nullptr);
  }
};

Barycentrics weights_of(const raster::Fragment& f) {
  return {{f.weights.b[0], f.weights.b[1], f.weights.b[2]}};
}

}  // namespace

Located locate(const SceneView& scene, std::uint64_t id) {
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint64_t count = primitive_count(scene.instances[i].geometry);
    if (id - first < count) return {i, id - first};
    first += count;
  }
  throw Error(Errc::invalid_argument, "primitive " + std::to_string(id) +
                                          " is out of range, the scene has " +
                                          std::to_string(first));
}

Barycentrics barycentrics(const SceneView& scene, const Camera& camera, int width, int height,
                          std::uint64_t id, int x, int y) {
  const Alone alone(scene, camera, width, height, id);
  return weights_of(alone.fragment(id, x, y));
}

Vec3d position(const SceneView& scene, const Located& at, const Barycentrics& where) {
  const raster::Draw draw = draw_of(scene, at, Mat4d::identity());
  raster::Fragment f;
  for (int c = 0; c < static_cast<int>(draw.topology); ++c) {
    f.vertex[c] = draw.vertex(at.primitive, c);
    f.weights.b[c] = where.weight[c];
  }
  return raster::position_on(scene.instances[at.instance], f);
}

Pick surface_of_key(const SceneView& scene, const Camera& camera, int width, int height,
                    std::uint64_t key, int x, int y) {
  const std::uint64_t id = raster::id_of_key(key);
  const Alone alone(scene, camera, width, height, id);
  const raster::Fragment f = alone.fragment(id, x, y);
  const raster::SurfaceScene surface(alone.scene, camera, width, height);
  Pick pick;
  pick.id = id;
  pick.instance = alone.at.instance;
  pick.instance_id = alone.instance.id.value_or(static_cast<std::int64_t>(alone.at.instance));
  pick.primitive = alone.at.primitive;
  pick.barycentrics = weights_of(f);
  pick.position = surface.position(f);
  pick.normal = surface.normal(f);
  pick.depth = std::bit_cast<float>(static_cast<std::uint32_t>(key >> raster::kIdBits));
  pick.view_depth = view_distance(camera, pick.depth);
  pick.distance = pick.view_depth * surface.ray_length(x, y);
  return pick;
}

}  // namespace rastrum
