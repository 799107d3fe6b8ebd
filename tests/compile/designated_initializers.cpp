// SPDX-License-Identifier: BSD-3-Clause
// Callers can initialize structs by designated initializers, with any single field, without a
// compiler warning about the other fields. (GCC's -Wmissing-field-initializers warns of fields
// without a default initializer, even spans and strings.) compile_test.cmake compiles this with
// -Wall -Wextra -Wpedantic -Werror.
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/family.hpp>
#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

namespace {
using namespace rastrum;

void use(const auto&...) {}

struct Shade {
  float value = 0;
  Shade operator+(const Shade& o) const { return {value + o.value}; }
  Shade operator*(float s) const { return {value * s}; }
};

// A draw points to its program, so a temporary program makes none.
template <class P>
concept MakesDraws = requires(P&& program) {
  std::forward<P>(program).draw(3);
};
using SomeProgram =
    Program<VertexOutput<Shade> (*)(std::uint32_t), Vec4 (*)(const Shade&, const Fragment&)>;
static_assert(MakesDraws<const SomeProgram&> && !MakesDraws<SomeProgram>);

void images() {
  std::uint8_t gray[6] = {};
  const ImageView<std::uint8_t> view{.data = gray, .width = 3, .height = 2};
  static_assert(ImageView<float>{.data = nullptr, .width = 3}.stride == 3);
  const Targets targets{.color8 = {}, .errors = {}};
  const Pass pass{.first_id = 1, .over = true};
  const Targets depth{.depth = {.data = nullptr, .width = 1, .height = 1}};
  use(view, targets, pass, depth);
  const Rgba8 red{.r = 255};
  const Vec3 up{.y = 1};
  use(red, up);
}

void scenes(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices) {
  const MeshView soup{.positions = positions};
  const MeshView mesh{.positions = positions, .indices = indices};
  const MeshView one_material{.positions = positions, .material = 1};
  const AttributeView<Vec3> normals{.values = positions};
  const InstanceView instance{.geometry = soup};
  const InstanceView placed{.object_to_world = Mat4d::identity()};
  // Instances are small and refer to objects that are kept. A reference to a temporary does not
  // compile.
  static_assert(sizeof(InstanceView) <= 240);
  static_assert(std::is_constructible_v<GeometryRef, const MeshView&>);
  static_assert(std::is_constructible_v<GeometryRef, const GeometryView&>);
  static_assert(!std::is_constructible_v<GeometryRef, MeshView>);
  static_assert(!std::is_constructible_v<GeometryRef, SpheresView>);
  static_assert(!std::is_constructible_v<GeometryRef, GeometryView>);
  static_assert(std::is_constructible_v<SceneBinding, const Scene&>);
  static_assert(!std::is_constructible_v<SceneBinding, Scene>);
  const SceneView scene{.instances = {&instance, 1}};
  const SceneView with_textures{.textures = {}};
  const Attribute<Vec2> texcoords{.values = {{0, 0}}};
  const Mesh owned{.name = "one", .positions = positions};
  const Instance number{.mesh = 1};
  const Scene file{.meshes = {owned}, .instances = {number}};
  const Material glass{.alpha_mode = AlphaMode::blend};
  const Material named{.name = "glass", .base_color = {1, 1, 1, 0.5F}};
  const Texture texture{.wrap_u = Wrap::clamp_to_edge};
  const Camera camera{.eye = {0, 0, 3}};
  const Camera parallel{.orthographic = true, .far_plane = 10};
  use(mesh, one_material, normals, placed, scene, with_textures, texcoords, file, glass, named,
      texture, camera, parallel);
}

void renders(const std::vector<std::uint32_t>& indices) {
  const RendererOptions threads{.threads = 2};
  const FrameOptions size{.width = 64, .height = 64};
  const FrameOptions shader{.shader = Shader::flat, .samples = 4};
  const FrameOptions filtered{.transparency = family::filtered(3)};
  const family::Row named{.rasterizer = "binned", .tuning = {.bin_px = 64}};
  const family::Row without{.hierarchical_z = false};
  const Primitives draw{.vertex_count = 3, .primitive_count = 1};
  const Primitives indexed{.indices = indices, .topology = Topology::lines};
  const VertexOutput<Shade> vertex{.clip = {0, 0, 0, 1}, .varying = {1}};
  const TerrainScene standing{.facing = {}};
  const TerrainScene scene{.scene = {}};
  use(threads, size, shader, filtered, named, without, draw, indexed, vertex, standing, scene);
}

void terrains() {
  using namespace terrain;
  const TerrainRendererOptions threads{.threads = 2};
  const TerrainOptions size{.width = 64, .height = 64};
  const TerrainOptions fog{.fog = {.density = 0.1}, .ground_clearance = 2};
  const TerrainOptions mip{.filter = terrain::MapFilter::mip};
  const TerrainCamera camera{.x = 1, .y = 2};
  const TerrainTargets targets{.depth = {}};
  const HeightMap map{.heights = Image<float>(1, 1)};
  const terrain::Light light{.sun = {.azimuth_deg = 90}, .shadows = Shadows::soft};
  const ShadowOptions shadows{.threads = 1};
  const March march{.steps = 16};
  const io::HeightGrid grid{.units_per_cell = 257};
  const io::RawSize raw{.width = 5};
  use(threads, size, fog, mip, camera, targets, map, light, shadows, march, grid, raw);
}
}  // namespace

int main() {
  images();
  scenes({}, {});
  renders({});
  terrains();
}
