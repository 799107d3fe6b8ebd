// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene/vertices_in_use.hpp>

namespace rastrum {
namespace {

/// Null: the geometry has no scalars of the name that the scene shows.
const NamedScalars* shown(const Scene& scene, const std::vector<NamedScalars>& scalars) {
  if (scene.shown_scalars.empty()) return nullptr;
  for (const NamedScalars& s : scalars)
    if (s.name == scene.shown_scalars) return &s;
  return nullptr;
}

void set_scalars(GeometryView& geometry, const ScalarView& values) {
  std::visit(
      [&](auto& g) {
        if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(g)>, MeshView>)
          g.scalars = values;
      },
      geometry);
}

/// Views of meshes, then of other geometries.
std::vector<GeometryView> views_of(const Scene& scene) {
  std::vector<GeometryView> views;
  views.reserve(scene.meshes.size() + scene.geometries.size());
  for (const Mesh& mesh : scene.meshes) {
    MeshView v = mesh.view();
    if (const NamedScalars* const s = shown(scene, mesh.scalars)) v.scalars = {s->values, s->per};
    views.emplace_back(v);
  }
  for (const Geometry& geometry : scene.geometries) {
    const NamedScalars* const s =
        std::visit([&](const auto& g) { return shown(scene, g.scalars); }, geometry);
    views.push_back(view(geometry));
    if (s != nullptr) set_scalars(views.back(), s->values);
  }
  return views;
}

/// The number of an instance's view in views_of(scene).
std::size_t view_number(const Scene& scene, const Instance& instance) {
  const auto require = [](std::size_t number, std::size_t count, const char* what) {
    if (number < count) return number;
    throw Error(Errc::invalid_argument, std::string("scene: an instance is of ")
                                            .append(what)
                                            .append(std::to_string(number))
                                            .append(", but there are only ")
                                            .append(std::to_string(count)));
  };
  if (!instance.geometry) return require(instance.mesh, scene.meshes.size(), "mesh ");
  return scene.meshes.size() + require(*instance.geometry, scene.geometries.size(), "geometry ");
}

}  // namespace

GeometryView view(const Geometry& geometry) {
  return std::visit([](const auto& g) -> GeometryView { return g.view(); }, geometry);
}

Material plain_material(bool has_colors) {
  Material m;
  m.name = "plain";
  m.metallic = 0;
  m.double_sided = true;
  // Vertex colours stay, and their alpha counts. Without them: linear light that sRGB turns into
  // the plain shaders' 0.8, 0.7, 0.6 to an ulp.
  if (has_colors)
    m.alpha_mode = AlphaMode::blend;
  else
    m.base_color = {0.603780866F, 0.447983563F, 0.318572849F, 1};
  return m;
}

void add_plain_materials(Scene& scene) {
  constexpr std::uint32_t kNone = ~0U;
  std::uint32_t plain = kNone, colored = kNone;
  const auto material_for = [&](bool has_colors) {
    std::uint32_t& index = has_colors ? colored : plain;
    if (index == kNone) {
      index = static_cast<std::uint32_t>(scene.materials.size());
      scene.materials.push_back(plain_material(has_colors));
    }
    return index;
  };
  for (Mesh& mesh : scene.meshes) {
    mesh.material = material_for(!mesh.colors.empty());
    mesh.face_materials = {};
  }
  for (Geometry& geometry : scene.geometries)
    std::visit([&](auto& g) { g.material = material_for(!g.colors.empty()); }, geometry);
  for (Instance& instance : scene.instances) {
    instance.material.reset();
    if (instance.color) instance.material = material_for(true);
  }
}

void Scene::place(const Mat4d& to_world) {
  const FloatScope floats;
  for (Instance& instance : instances)
    instance.object_to_world = to_world * instance.object_to_world;
  for (Motion& motion : motions) motion.to_world = to_world * motion.to_world;
  for (Light& light : lights) light = placed(light, to_world);
}

void Scene::append(Scene other) {
  const auto mesh_offset = static_cast<std::uint32_t>(meshes.size());
  const auto geometry_offset = static_cast<std::uint32_t>(geometries.size());
  const auto mapping_offset = static_cast<std::uint32_t>(scalar_mappings.size());
  const auto texture_offset = static_cast<std::int32_t>(textures.size());
  // A file without materials keeps its look when another file brings some.
  const bool any_materials = !materials.empty() || !other.materials.empty();
  if (any_materials && materials.empty()) add_plain_materials(*this);
  if (any_materials && other.materials.empty()) add_plain_materials(other);
  const auto material_offset = static_cast<std::uint32_t>(materials.size());

  for (Motion& motion : other.motions) {
    motion.first_mesh += mesh_offset;
    motion.first_instance += static_cast<std::uint32_t>(instances.size());
    motion.first_camera += static_cast<std::uint32_t>(cameras.size());
    motion.first_light += static_cast<std::uint32_t>(lights.size());
    motions.push_back(std::move(motion));
  }
  for (Mesh& mesh : other.meshes) {
    mesh.material += material_offset;
    for (std::uint32_t& m : mesh.face_materials) m += material_offset;
    meshes.push_back(std::move(mesh));
  }
  for (Geometry& geometry : other.geometries) {
    std::visit([&](auto& g) { g.material += material_offset; }, geometry);
    geometries.push_back(std::move(geometry));
  }
  for (Instance& instance : other.instances) {
    instance.mesh += mesh_offset;
    if (instance.geometry) *instance.geometry += geometry_offset;
    if (instance.material) *instance.material += material_offset;
    instance.scalar_mapping += mapping_offset;
    instances.push_back(std::move(instance));
  }
  for (Material& m : other.materials) {
    for (std::int32_t* t : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                            &m.occlusion_texture, &m.emissive_texture, &m.alpha_texture})
      if (*t != kNoTexture) *t += texture_offset;
    materials.push_back(std::move(m));
  }
  std::move(other.textures.begin(), other.textures.end(), std::back_inserter(textures));
  std::move(other.scalar_mappings.begin(), other.scalar_mappings.end(),
            std::back_inserter(scalar_mappings));
  std::move(other.cameras.begin(), other.cameras.end(), std::back_inserter(cameras));
  std::move(other.lights.begin(), other.lights.end(), std::back_inserter(lights));
  std::move(other.warnings.begin(), other.warnings.end(), std::back_inserter(warnings));
}

std::uint64_t Scene::triangle_count() const {
  std::uint64_t n = 0;
  for (const Instance& i : instances)
    if (const std::size_t number = view_number(*this, i); number < meshes.size())
      n += meshes[number].triangle_count();
  return n;
}

std::uint64_t Scene::primitive_count() const {
  const std::vector<GeometryView> views = views_of(*this);
  std::uint64_t n = 0;
  for (const Instance& i : instances) n += rastrum::primitive_count(views[view_number(*this, i)]);
  return n;
}

SceneView SceneBinding::view() const {
  return {instances_, scene_->materials, scene_->textures, scene_->scalar_mappings};
}

SceneBinding::SceneBinding(const Scene& scene) : scene_("SceneBinding", &scene) {
  instances_.reserve(scene.instances.size());
  for (const Instance& i : scene.instances) {
    InstanceView& instance = instances_.emplace_back();
    instance.object_to_world = i.object_to_world;
    instance.opacity = i.opacity;
    instance.color = i.color;
    instance.material = i.material;
    instance.visible = i.visible;
    instance.casts_shadows = i.casts_shadows;
    instance.winding = i.winding;
    instance.id = i.id;
    instance.clip_planes = i.clip_planes;
    instance.scalar = i.scalar;
    instance.scalar_mapping = i.scalar_mapping;
  }
  show(views_of(scene));
}

void SceneBinding::show(std::vector<GeometryView> views) {
  views_ = std::make_unique<const std::vector<GeometryView>>(std::move(views));
  for (std::size_t i = 0; i < instances_.size(); ++i)
    instances_[i].geometry = (*views_)[view_number(*scene_, scene_->instances[i])];
}

void SceneBinding::prepare(int threads) {
  const FloatScope floats;
  std::vector<GeometryView> views = views_of(*scene_);
  std::vector<PreparedMesh> prepared;
  std::vector<bool> done(views.size());
  for (const Instance& i : scene_->instances) {
    const std::size_t number = view_number(*scene_, i);
    if (i.geometry || done[number]) continue;
    done[number] = true;
    views[number] = prepared.emplace_back(std::get<MeshView>(views[number]), threads).view();
  }
  show(std::move(views));
  prepared_ = std::move(prepared);
}

namespace {

/// Any vertex changes the count, so all are read.
struct CountedExtent {
  ExtentOfVertices extent;
  std::uint64_t count = 0;

  void add(const Vec3d& p) {
    extent.add(p);
    ++count;
  }
  void merge(const CountedExtent& later) {
    extent.merge(later.extent);
    count += later.count;
  }
  [[nodiscard]] std::array<double, 1> values() const { return {static_cast<double>(count)}; }
  [[nodiscard]] static std::array<double, 1> bounds(const VerticesInUse::WorldBox&) {
    return {std::numeric_limits<double>::infinity()};
  }
};

}  // namespace

Bounds bounds(const SceneView& scene) {
  const FloatScope floats;
  const auto b = VerticesInUse(scene).reduce(CountedExtent{});
  if (b.count == 0) return {};
  return {b.extent.min, b.extent.max, b.count};
}

Camera fit_camera(const SceneView& scene, float fov_rad, bool orthographic, Vec3d direction,
                  Vec3d up, FitRanks* ranks) {
  const FloatScope floats;
  check_fov(fov_rad);
  Camera along;
  along.eye = -normalize(direction);
  along.up = up;
  (void)world_to_camera(along);  // throws without a direction
  const BoundingSphere ball = bounding_sphere(scene, ranks);
  const double distance = ball.radius / elementary::sin(static_cast<double>(fov_rad) / 2);
  Camera camera;
  camera.fov_rad = fov_rad;
  camera.orthographic = orthographic;
  camera.target = ball.centre;
  camera.eye = ball.centre + along.eye * distance;
  camera.up = up;
  if (orthographic) camera.orthographic_height = static_cast<float>(2 * ball.radius);
  place_planes(camera, ball);
  return camera;
}

std::vector<Vec3> vertex_normals(const ArrayView<Vec3>& positions, const IndexView& indices) {
  const FloatScope floats;
  MeshView mesh;
  mesh.positions = positions;
  mesh.indices = indices;
  check_indices(mesh);
  std::vector<Vec3d> sums(positions.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t corner[3] = {mesh.vertex(3 * t), mesh.vertex(3 * t + 1),
                                     mesh.vertex(3 * t + 2)};
    const Vec3d a = positions.wide(corner[0]);
    const Vec3d n = cross(positions.wide(corner[1]) - a, positions.wide(corner[2]) - a);
    if (!is_finite(n)) continue;
    for (const std::uint32_t c : corner) sums[c] = sums[c] + n;
  }
  std::vector<Vec3> normals(positions.size());
  std::ranges::transform(sums, normals.begin(), [](const Vec3d& sum) {
    return Vec3(direction_of(sum).value_or(Vec3d{}));
  });
  return normals;
}

}  // namespace rastrum
