// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::bench {
namespace {

/// A million triangles of about a pixel at 1024²: at the default camera's distance from the soup's
/// cube a pixel is 0.0039 wide.
constexpr std::string_view kScattered = "soup?count=1000000&min_size=0.004&max_size=0.0065";

std::filesystem::path data_file(std::string_view name) {
  const char* shared = std::getenv("RASTRUM_SHARED");
  return std::filesystem::path(shared != nullptr ? shared : RASTRUM_SHARED_DIR) / "data" / name;
}

}  // namespace

const std::vector<SceneInfo>& peer_scenes() {
  static const std::vector<SceneInfo> scenes{
      {"suzanne", "small/suzanne.obj", {}},
      {"teapot", "small/teapot.obj", {}},
      {"bunny", "small/stanford-bunny.obj", {}},
      {"sponza", "sponza/sponza.obj", {}},
      {"dragon", "big/dragon_348k.ply", {}},
      {"scattered", {}, kScattered, 0, true},
      {"brain", "big/brain_iso126_1033k.ply", {}},
      {"bunny-1m", "small/stanford-bunny.obj", {}, 2},
      {"bunny-4m", "small/stanford-bunny.obj", {}, 3},
  };
  return scenes;
}

const std::vector<SceneInfo>& largest_scenes() {
  static const std::vector<SceneInfo> scenes{
      {"bunny-17m", "small/stanford-bunny.obj", {}, 4},
  };
  return scenes;
}

const std::vector<SceneInfo>& transparency_scenes() {
  static const std::vector<SceneInfo> scenes{
      {"pine", "alpha/smallpine/scene.gltf", {}},
      {"teapot", "small/teapot.obj", {}},
      {"boxes", {}, "boxes?count=10"},  // 12,000 triangles, the paper's number
      {"bunny", "small/stanford-bunny.obj", {}},
      {"engine", "depth/2CylinderEngine.glb", {}},
      {"hair", "depth/ratboy_mohawk_ribbons_138k.ply", {}},
      {"sponza", "sponza/sponza.obj", {}},
      {"dragon", "big/dragon_348k.ply", {}},
      {"brain", "big/brain_iso126_1033k.ply", {}},
      {"hairball", {}, "hairball"},  // 2,880,000, the paper's number
  };
  return scenes;
}

const std::vector<SceneInfo>& procedural_scenes() {
  static const std::vector<SceneInfo> scenes{
      {"shape-teapot", {}, "teapot?n=10"},
      {"torus-knot", {}, "torus_knot?segments=1500&sides=24"},
      {"gyroid", {}, "gyroid?cells=160"},
      {"scattered", {}, kScattered, 0, true},
  };
  return scenes;
}

const SceneInfo& scene_by_name(std::string_view name) {
  std::string known;
  for (const auto* list :
       {&peer_scenes(), &transparency_scenes(), &procedural_scenes(), &largest_scenes()})
    for (const SceneInfo& scene : *list) {
      if (scene.name == name) return scene;
      known += (known.empty() ? "" : ", ") + std::string(scene.name);
    }
  throw Error(Errc::invalid_argument,
              "there is no scene \"" + std::string(name) + "\"; known are " + known);
}

Mesh flatten(const Scene& scene) {
  Mesh flat;
  for (const Instance& instance : scene.instances) {
    if (instance.geometry) continue;  // only triangles are compared
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Mat4 to_world = static_cast<Mat4>(instance.object_to_world);
    if (flat.positions.size() + mesh.positions.size() > std::numeric_limits<std::uint32_t>::max())
      throw Error(Errc::unsupported, "the scene has more than 2^32 vertices");
    const auto base = static_cast<std::uint32_t>(flat.positions.size());
    for (const Vec3 p : mesh.positions) {
      const Vec4 q = transform_point(to_world, p);
      flat.positions.push_back({q.x, q.y, q.z});
    }
    const std::size_t corners = mesh.triangle_count() * 3;
    for (std::size_t i = 0; i < corners; ++i)
      flat.indices.push_back(
          base + (mesh.indices.empty() ? static_cast<std::uint32_t>(i) : mesh.indices[i]));
  }
  return flat;
}

bool available(const SceneInfo& scene) {
  return scene.file.empty() || std::filesystem::exists(data_file(scene.file));
}

Scene load_whole(const SceneInfo& scene) {
  if (!scene.file.empty()) return io::read_scene(data_file(scene.file));
  Scene one;
  one.meshes.push_back(shapes::from_spec(scene.shape));
  one.instances.push_back({});
  return one;
}

Mesh load(const SceneInfo& scene) {
  Mesh mesh = flatten(load_whole(scene));
  if (scene.subdivide > 0) mesh = shapes::subdivide(mesh, scene.subdivide);
  mesh.normals = {vertex_normals(mesh.positions, mesh.indices), {}};
  return mesh;
}

std::vector<Camera> walk(const SceneView& scene, int steps) {
  const Bounds box = bounds(scene);
  const Vec3d low(box.min), size = Vec3d(box.max) - low;
  const bool along_x = size.x > size.z;
  std::vector<Camera> cameras;
  for (int i = 0; i < steps; ++i) {
    const double t = 0.1 + 0.8 * i / steps, turn = 1.2 * std::sin(9.0 * i / steps);
    Camera c;
    const double half = 0.5 + 0.02 * std::sin(5.0 * i / steps);
    c.eye = {low.x + size.x * (along_x ? t : half), low.y + size.y * 0.3,
             low.z + size.z * (along_x ? half : t)};
    const Vec3d ahead = along_x ? Vec3d{std::cos(turn), 0.1, std::sin(turn)}
                                : Vec3d{std::sin(turn), 0.1, std::cos(turn)};
    c.target = c.eye + ahead;
    c.near_plane = static_cast<float>(length(size) * 1e-4);
    cameras.push_back(c);
  }
  return cameras;
}

}  // namespace rastrum::bench
