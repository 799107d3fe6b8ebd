// What a Renderer refuses of its options and targets, and that the message names it.
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/isa.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::refusals_test {
namespace {

constexpr int kW = 16, kH = 12;

RenderOptions options_with(const std::function<void(RenderOptions&)>& change = {}) {
  RenderOptions o;
  o.width = kW;
  o.height = kH;
  o.threads = 1;
  if (change) change(o);
  return o;
}

/// What the Error of `f` says; empty where there is none.
std::string message_of(const std::function<void()>& f, Errc code = Errc::invalid_argument) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code) << e.what();
    return e.what();
  }
  return "";
}

std::string message_of_options(const std::function<void(RenderOptions&)>& change) {
  return message_of([&] { const Painter renderer(options_with(change)); });
}

void expect_refused(const char* part, const std::function<void(RenderOptions&)>& change) {
  const std::string message = message_of_options(change);
  EXPECT_NE(message.find(part), std::string::npos) << part << ": '" << message << "'";
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
                 [](auto& o) { o.tuning.schedule = no_value<raster::Schedule>(); });
  expect_refused("blocks is 200", [](auto& o) { o.tuning.order = no_value<raster::BlockOrder>(); });
  expect_refused("small triangles is 200",
                 [](auto& o) { o.tuning.small_path = no_value<raster::SmallPath>(); });
}

TEST(Refusals, InstructionSetsThatAreNotThere) {
  for (const Device device : {Device::serial, Device::threads})
    for (const char* rasterizer : {"auto", "reference"}) {
      const RenderOptions o = options_with([&](auto& changed) {
        changed.device = device;
        changed.rasterizer = rasterizer;
        changed.isa = missing_isa();
      });
      const std::string said = message_of([&] { const Renderer renderer(o); }, Errc::no_device);
      EXPECT_NE(said.find("--isa"), std::string::npos) << said;
    }
}

TEST(Refusals, NamesOfShadersThatAreNone) {
  EXPECT_NE(message_of([] { static_cast<void>(name(no_value<Shader>())); }).find("shader is 200"),
            std::string::npos);
  EXPECT_NE(message_of([] { static_cast<void>(shader_from_name("toon")); }).find("'toon'"),
            std::string::npos);
}

TEST(Refusals, BackgroundsThatAreNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()})
    for (float Vec4::*channel : {&Vec4::x, &Vec4::y, &Vec4::z, &Vec4::w})
      expect_refused("background", [&](auto& o) { o.background.*channel = bad; });
  EXPECT_EQ(message_of_options([](auto& o) { o.background.x = 4; }), "");
}

std::string message_of_draw(const std::function<void(raster::Draw&)>& change) {
  return message_of([&] {
    Painter renderer(options_with());
    raster::Draw draw;
    change(draw);
    class Nothing final : public raster::BlockShader {
      bool shade(const raster::FrameGeometry&, const raster::VisibleBlock&, Isa,
                 raster::BlockColors&) const noexcept override {
        return true;
      }
    };
    renderer.draw({&draw, 1}, Nothing(), nullptr, {});
  });
}

TEST(Refusals, EnumsOfADraw) {
  const auto expect = [](const char* part, const std::function<void(raster::Draw&)>& change) {
    const std::string message = message_of_draw(change);
    EXPECT_NE(message.find(part), std::string::npos) << part << ": '" << message << "'";
  };
  expect("topology is 0", [](raster::Draw& d) { d.topology = static_cast<raster::Topology>(0); });
  expect("topology is 200", [](raster::Draw& d) { d.topology = no_value<raster::Topology>(); });
  expect("cull is 200", [](raster::Draw& d) { d.cull = no_value<Cull>(); });
  expect("winding is 200", [](raster::Draw& d) { d.winding = no_value<raster::Winding>(); });
}

TEST(Refusals, EnumsOfMaterialsAndTextures) {
  Scene scene = single(shapes::boxes(1));
  scene.materials.resize(1);
  scene.textures.resize(1);
  scene.textures[0].image = Image<Rgba8>(1, 1);
  const auto message = [&](const Scene& changed) {
    return message_of([&] {
      Image<Rgba8> image(kW, kH);
      Targets targets;
      targets.color8 = image;
      Painter(options_with()).render(SceneBinding(changed).view(), Camera{}, targets);
    });
  };
  EXPECT_EQ(message(scene), "");
  Scene bad = scene;
  bad.materials[0].alpha_mode = no_value<AlphaMode>();
  EXPECT_NE(message(bad).find("material 0: its alpha mode is 200"), std::string::npos);
  bad = scene;
  bad.textures[0].wrap_v = no_value<Wrap>();
  EXPECT_NE(message(bad).find("texture 0: its wrapping is 200"), std::string::npos);
  bad = scene;
  bad.textures[0].min = no_value<TextureFilter>();
  EXPECT_NE(message(bad).find("texture 0: its filter is 200"), std::string::npos);
}

/// Renders a box into targets that `fill` makes.
std::string message_of_targets(const std::function<void(Targets&)>& fill,
                               Shader shader = Shader::flat) {
  const Scene scene = single(shapes::boxes(1));
  return message_of([&] {
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
  for (const int stride : {kW, 2 * kW, -kW})
    EXPECT_EQ(message_of_targets([&](Targets& t) {
                t.*member = {middle, kW, kH, stride};
              }),
              "")
        << name << " " << stride;
  for (const int stride : {0, kW - 1, 1 - kW}) {
    const std::string message = message_of_targets([&](Targets& t) {
      t.*member = {middle, kW, kH, stride};
    });
    EXPECT_NE(message.find("the " + name + " target: rows of 16 pixels overlap"), std::string::npos)
        << name << " " << stride << ": '" << message << "'";
  }
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

}  // namespace
}  // namespace rastrum::test::refusals_test
