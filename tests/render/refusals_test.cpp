// SPDX-License-Identifier: BSD-3-Clause
// A Renderer refuses bad options and targets, and the message names them.
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/isa.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::refusals_test {
namespace {

constexpr int kW = 16, kH = 12;

RenderOptions options_with(const std::function<void(RenderOptions&)>& change = {}) {
  RenderOptions o({.width = kW, .height = kH}, {.threads = 1});
  if (change) change(o);
  return o;
}

std::string message_of_options(const std::function<void(RenderOptions&)>& change) {
  return error_message_of([&] { const Painter renderer(options_with(change)); });
}

void expect_refused(const char* part, const std::function<void(RenderOptions&)>& change) {
  EXPECT_TRUE(holds(message_of_options(change), part));
}

template <class E>
E no_value() {
  return static_cast<E>(200);
}

TEST(Refusals, EnumsWithoutAValue) {
  EXPECT_EQ(message_of_options({}), "");
  expect_refused("the shader is 200", [](auto& o) { o.shader = no_value<Shader>(); });
  expect_refused("cull is 200", [](auto& o) { o.cull = no_value<Cull>(); });
  expect_refused("device is 200", [](auto& o) { o.device = no_value<Device>(); });
  expect_refused("isa is 200", [](auto& o) { o.isa = no_value<Isa>(); });
  expect_refused("transparency is 200",
                 [](auto& o) { o.transparency.method = no_value<Transparency>(); });
  expect_refused("schedule is 200",
                 [](auto& o) { o.tuning.schedule = no_value<family::Schedule>(); });
  expect_refused("blocks is 200", [](auto& o) { o.tuning.order = no_value<family::BlockOrder>(); });
  expect_refused("small triangles is 200",
                 [](auto& o) { o.tuning.small_path = no_value<family::SmallPath>(); });
}

TEST(Refusals, InstructionSetsThatAreNotThere) {
  for (const Device device : {Device::serial, Device::threads})
    for (const char* rasterizer : {"auto", "reference"}) {
      const RenderOptions o = options_with([&](auto& changed) {
        changed.device = device;
        changed.rasterizer = rasterizer;
        changed.isa = missing_isa();
      });
      test::expect_refused("--isa", Errc::no_device, [&] { const Renderer renderer(o); });
    }
}

TEST(Refusals, NamesOfShadersThatAreNone) {
  test::expect_refused("shader is 200", [] { static_cast<void>(name(no_value<Shader>())); });
  test::expect_refused("'toon'", [] { static_cast<void>(shader_from_name("toon")); });
}

TEST(Refusals, BackgroundsThatAreNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()})
    for (float Vec4::*channel : {&Vec4::x, &Vec4::y, &Vec4::z, &Vec4::w})
      expect_refused("background", [&](auto& o) { o.background.*channel = bad; });
  EXPECT_EQ(message_of_options([](auto& o) { o.background.x = 4; }), "");
}

TEST(Refusals, DrawsWithoutAProgram) {
  const ProgramDraw none;
  test::expect_refused("draw 0 has no program; make draws by Program::draw", [&] {
    Renderer({.threads = 1}).draw({&none, 1}, {.width = kW, .height = kH}, {});
  });
}

TEST(Refusals, EnumsOfADraw) {
  class Nothing final : public raster::BlockShader {
    bool shade(const raster::FrameGeometry&, const raster::VisibleBlock&, Isa,
               raster::BlockColors&) const noexcept override {
      return true;
    }
  };
  const auto expect = [](const char* part, const std::function<void(raster::Draw&)>& change) {
    Painter renderer(options_with());
    raster::Draw draw;
    change(draw);
    test::expect_refused(part, [&] { renderer.draw({&draw, 1}, Nothing(), nullptr, {}); });
  };
  expect("topology is 0", [](raster::Draw& d) { d.topology = static_cast<Topology>(0); });
  expect("topology is 200", [](raster::Draw& d) { d.topology = no_value<Topology>(); });
  expect("cull is 200", [](raster::Draw& d) { d.cull = no_value<Cull>(); });
  expect("winding is 200", [](raster::Draw& d) { d.winding = no_value<Winding>(); });
}

TEST(Refusals, EnumsOfMaterialsAndTextures) {
  const auto message = [&](const std::function<void(Material&, Texture&)>& change) {
    Scene scene = single(shapes::boxes(1));
    change(scene.materials.emplace_back(), scene.textures.emplace_back());
    scene.textures[0].image = Image<Rgba8>(1, 1);
    return error_message_of([&] { (void)draw(options_with(), scene, Camera{}); });
  };
  EXPECT_EQ(message([](Material&, Texture&) {}), "");
  EXPECT_TRUE(holds(message([](Material& m, Texture&) { m.alpha_mode = no_value<AlphaMode>(); }),
                    "material 0: its alpha mode is 200"));
  EXPECT_TRUE(holds(message([](Material&, Texture& t) { t.wrap_v = no_value<Wrap>(); }),
                    "texture 0: its wrapping is 200"));
  EXPECT_TRUE(holds(message([](Material&, Texture& t) { t.min = no_value<TextureFilter>(); }),
                    "texture 0: its filter is 200"));
}

/// Renders a box into targets that `fill` makes.
std::string message_of_targets(const std::function<void(Targets&)>& fill,
                               Shader shader = Shader::flat) {
  const Scene scene = single(shapes::boxes(1));
  return error_message_of([&] {
    Targets targets;
    fill(targets);
    Painter(options_with([&](auto& o) {
      o.shader = shader;
    })).render(SceneBinding(scene).view(), Camera{}, targets);
  });
}

template <class T>
void expect_strides(ImageView<T> Targets::*member, const std::string& name) {
  std::vector<T> pixels(static_cast<std::size_t>(3 * kW * kH));
  T* const middle = pixels.data() + kW * kH;
  const auto message = [&](int stride) {
    return message_of_targets([&](Targets& t) { t.*member = {middle, kW, kH, stride}; });
  };
  for (const int stride : {kW, 2 * kW, -kW}) EXPECT_EQ(message(stride), "") << name << stride;
  for (const int stride : {0, kW - 1, 1 - kW})
    EXPECT_TRUE(holds(message(stride), "the " + name + " target: rows of 16 pixels overlap"))
        << stride;
}

TEST(Refusals, TargetsWhoseRowsOverlap) {
  expect_strides(&Targets::color8, "color8");
  expect_strides(&Targets::color, "color");
  expect_strides(&Targets::depth, "depth");
  expect_strides(&Targets::ids, "ids");
  expect_strides(&Targets::overdraw, "overdraw");
  expect_strides(&Targets::keys, "keys");
  expect_strides(&Targets::errors, "errors");
}

// The depth shader writes its colours after the frame.
TEST(Refusals, TargetsOfAnotherSizeWithEveryShader) {
  Image<Rgba8> small(8, 8);
  Image<Vec4> small_float(8, 8);
  for (const Shader shader : {Shader::flat, Shader::depth}) {
    EXPECT_EQ(message_of_targets([&](Targets& t) { t.color8 = small; }, shader),
              "the color8 target is 8x8 and must be 16x12, as the frame is");
    EXPECT_EQ(message_of_targets([&](Targets& t) { t.color = small_float; }, shader),
              "the color target is 8x8 and must be 16x12, as the frame is");
  }
}

/// A valid call. Each row of the table below makes it invalid.
struct Call {
  std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  std::vector<std::uint32_t> quad{0, 1, 2, 3};
  std::vector<Vec3> normals{4, Vec3{0, 0, 1}}, nine{9, Vec3{0, 0, 1}};
  std::vector<Vec4> colors{9, Vec4{1, 1, 1, 1}};
  std::vector<std::uint32_t> face_materials{3, 0};
  std::vector<float> one{1};
  std::vector<Material> materials{1};
  std::vector<Vec4> memory = std::vector<Vec4>(4 * kW * kH);
  MeshView mesh{.positions = positions, .indices = indices, .normals = {normals}};
  InstanceView instance{};
  GeometryView geometry{};  ///< replaces the mesh
  FrameOptions frame{.width = kW, .height = kH};
  Targets targets{.color = {memory.data(), kW, kH}};

  Call() = default;
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  template <class T>
  [[nodiscard]] ImageView<T> image(void* at) const {
    return {static_cast<T*>(at), kW, kH};
  }
  std::string message() {
    const MeshView* const other = std::get_if<MeshView>(&geometry);
    instance.geometry = other != nullptr ? GeometryRef(mesh) : geometry;
    const SceneView scene{{&instance, 1}, materials, {}, {}};
    return error_message_of(
        [&] { Renderer({.threads = 1}).render(scene, square_camera(), frame, targets); });
  }
};

struct WrongCall {
  const char* said;
  std::function<void(Call&)> change;
};

template <class T>
AttributeView<T> each(const std::vector<T>& values, Per per) {
  return {values, {}, per};
}

// Invalid calls are refused before anything is drawn.
TEST(Refusals, CallsThatCannotBeMeant) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Call().message(), "");
  const WrongCall calls[] = {
      {"has 4 indices, which are no whole number of triangles",
       [](Call& c) { c.mesh.indices = c.quad; }},
      {"has 4 positions without indices, which are no whole number of triangles",
       [](Call& c) { c.mesh.indices = {}; }},
      {"has 6 indices, which are no whole number of quads",
       [](Call& c) { c.mesh.faces.kind = FaceKind::quads; }},
      {"normals are more (9) than positions (4)", [](Call& c) { c.mesh.normals.values = c.nine; }},
      {"normals are more (9) than corners (6)",
       [](Call& c) { c.mesh.normals = each(c.nine, Per::corner); }},
      {"colors are more (9) than faces (2)",
       [](Call& c) { c.mesh.colors = each(c.colors, Per::face); }},
      {"colors are more (9) than meshes (1)",
       [](Call& c) { c.mesh.colors = each(c.colors, Per::mesh); }},
      {"normals.indices are fewer (4) than corners (6)",
       [](Call& c) { c.mesh.normals.indices = c.quad; }},
      {"material 3 is out of range, there are 1",
       [](Call& c) { c.mesh.face_materials = c.face_materials; }},
      {"face materials are more (4) than triangles (2)",
       [](Call& c) { c.mesh.face_materials = c.quad; }},
      {"colors are more (9) than positions (4)",
       [](Call& c) { c.geometry = PointsView{.positions = c.positions, .colors = c.colors}; }},
      {"colors are more (9) than positions (4)",
       [](Call& c) { c.geometry = LinesView{.positions = c.positions, .colors = c.colors}; }},
      {"colors are more (9) than spheres (4)",
       [](Call& c) { c.geometry = SpheresView{.centers = c.positions, .colors = c.colors}; }},
      {"normals are more (9) than discs (4)",
       [](Call& c) { c.geometry = DiscsView{.centers = c.positions, .normals = c.nine}; }},
      {"colors are fewer (1) than spheres (4)",
       [](Call& c) {
         c.geometry = SpheresView{.centers = c.positions, .colors = std::span(c.colors).first(1)};
       }},
      {"radii are fewer (1) than spheres (4)",
       [](Call& c) { c.geometry = SpheresView{.centers = c.positions, .radii = c.one}; }},
      {"radii are fewer (1) than positions (4)",
       [](Call& c) { c.geometry = CylindersView{.positions = c.positions, .radii = c.one}; }},
      {"normals are fewer (0) than discs (4)",
       [](Call& c) { c.geometry = DiscsView{.centers = c.positions}; }},
      {"material 3 is out of range, there are 1",
       [](Call& c) { c.geometry = SpheresView{.centers = c.positions, .material = 3}; }},
      {"the number of ends, 3, is odd",
       [](Call& c) { c.geometry = CylindersView{.positions = std::span(c.positions).first(3)}; }},
      {"instance 0: object_to_world must be finite",
       [=](Call& c) { c.instance.object_to_world.m[1][2] = kNan; }},
      {"instance 0: object_to_world must be finite",
       [](Call& c) {
         c.instance.object_to_world.m[3][3] = std::numeric_limits<double>::infinity();
       }},
      {"material 0: its base_color must be finite",
       [=](Call& c) { c.materials[0].base_color.y = kNan; }},
      {"material 0: its roughness must be finite",
       [=](Call& c) { c.materials[0].roughness = kNan; }},
      {"material 0: its metallic must be finite", [=](Call& c) { c.materials[0].metallic = kNan; }},
      {"material 0: its emissive must be finite",
       [=](Call& c) { c.materials[0].emissive.z = kNan; }},
      {"material 0: its alpha_cutoff must be finite",
       [=](Call& c) { c.materials[0].alpha_cutoff = kNan; }},
      {"material 1 is out of range, there are 1", [](Call& c) { c.mesh.material = 1; }},
      {"material 1 is out of range, there are 1", [](Call& c) { c.instance.material = 1; }},
      {"material 5 is out of range, there are 0",
       [](Call& c) {
         c.materials.clear();
         c.instance.material = 5;
       }},
      {"material 5 is out of range, there are 0",
       [](Call& c) {
         c.materials.clear();
         c.geometry = SpheresView{.centers = c.positions, .material = 5};
       }},
      {"material 0: texture 0 is out of range",
       [](Call& c) { c.materials[0].base_color_texture = 0; }},
      {"the color8 target has its 64x64 pixels at a null pointer",
       [](Call& c) {
         c.targets.color8 = ImageView<Rgba8>{nullptr, 64, 64};
       }},
      {"the targets color8 and color overlap",
       [](Call& c) { c.targets.color8 = c.image<Rgba8>(c.memory.data()); }},
      {"the targets color and depth overlap",
       [](Call& c) { c.targets.depth = c.image<float>(c.memory.data() + kW * kH - 1); }},
      {"the targets depth and ids overlap",
       [](Call& c) {
         c.targets.depth = c.image<float>(c.memory.data() + kW * kH);
         c.targets.ids = c.image<std::int64_t>(c.memory.data() + kW * kH + 20);
       }},
      {"its positions and the depth target overlap",
       [](Call& c) {
         c.targets.depth = c.image<float>(c.memory.data() + kW * kH);
         c.mesh.positions = ArrayView<Vec3>::of(c.targets.depth.data + 5, 4);
       }},
      {"its indices and the color target overlap",
       [](Call& c) {
         c.mesh.indices = IndexView::of(
             static_cast<const std::uint8_t*>(static_cast<void*>(c.memory.data())), 6);
       }},
  };
  for (const WrongCall& wrong : calls) {
    Call call;
    wrong.change(call);
    EXPECT_TRUE(holds(call.message(), wrong.said));
  }
}

// Parts of one image that share rows but no columns do not overlap.
TEST(Refusals, NoTargetsSideBySide) {
  Call call;
  std::vector<Vec4> wide(2 * kW * kH);
  call.targets.color = {wide.data(), kW, kH, 2 * kW};
  call.targets.linear = {wide.data() + kW, kW, kH, 2 * kW};
  call.frame.shader = Shader::material;
  EXPECT_EQ(call.message(), "");
  call.targets.linear.data -= 1;
  EXPECT_TRUE(holds(call.message(), "overlap"));
  // The last row first.
  call.targets.linear = {wide.data() + (kH - 1) * 2 * kW + kW, kW, kH, -2 * kW};
  EXPECT_EQ(call.message(), "");
}

TEST(Refusals, LayoutsWithoutAStrideArePacked) {
  const float numbers[] = {1, 2, 3, 4, 5, 6};
  const auto bytes = std::as_bytes(std::span(numbers));
  const auto values = ArrayView<Vec3>::in(bytes, {.channels = 3, .count = 2});
  EXPECT_EQ(values[1].x, 4);
  EXPECT_EQ((ArrayView<Vec3>::in(bytes, {.channels = 3, .count = 2, .stride_bytes = 0})[1].x), 1);
  EXPECT_EQ(ScalarView::in(bytes, {.count = 6})[5], 6);
  test::expect_refused("reach beyond",
                       [&] { (void)ArrayView<Vec3>::in(bytes, {.channels = 3, .count = 3}); });
}

}  // namespace
}  // namespace rastrum::test::refusals_test
