// SPDX-License-Identifier: BSD-3-Clause
// Environments as light and as background.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/light.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/colors.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/small_environment.hpp"

namespace rastrum::test::environment_light_test {
namespace {

constexpr int kSize = 96;
constexpr float kQuarter = std::numbers::pi_v<float> / 2;

struct Look {
  Scene scene = shapes::scene_from_spec("spheres");
  Camera camera = fit_camera(SceneBinding(scene).view(), 1, false);
};

Image<Vec4> draw(const Look& look, FrameOptions frame, RendererOptions options = {.threads = 2}) {
  frame.width = frame.height = kSize;
  Image<Vec4> color(kSize, kSize);
  Renderer(options).render(SceneBinding(look.scene).view(), look.camera, frame, {.color = color});
  return color;
}

/// An environment light takes 0.3 s of a core, ten times that under a sanitizer, so a test makes
/// only one of a picture.
Light light_of(const Environment& environment, float turn_rad = 0, Vec3 up = {0, 1, 0}) {
  return Light{.kind = EnvironmentLight{environment, up, turn_rad}};
}
Light light_of(const Image<Vec3>& picture) {
  return light_of(Environment(picture.view()));
}
Image<Vec3> constant(Vec3 light) {
  Image<Vec3> picture(128, 64);
  for (const auto& [x, y] : pixels(128, 64)) picture(x, y) = light;
  return picture;
}
FrameOptions lit_by(std::vector<Light> lights, Shader shader) {
  return FrameOptions{.shader = shader, .lights = std::move(lights)};
}
double most_apart(const Image<Vec4>& a, const Image<Vec4>& b) {
  double most = 0;
  for (const auto& [x, y] : pixels(a.width(), a.height())) {
    const Vec4 d = a(x, y) + b(x, y) * -1.0F;
    most = std::max({most, std::abs(static_cast<double>(d.x)), std::abs(static_cast<double>(d.y)),
                     std::abs(static_cast<double>(d.z))});
  }
  return most;
}

TEST(EnvironmentLights, ThatAreTheSameEverywhereAreAmbient) {
  const Look look;
  Light ambient{.kind = AmbientLight{}, .color = {0.3F, 0.5F, 0.7F}};
  const Light around = light_of(constant(ambient.color));
  for (const Shader shader : {Shader::lambert, Shader::phong, Shader::material}) {
    const auto a = draw(look, lit_by({ambient}, shader));
    const auto b = draw(look, lit_by({around}, shader));
    EXPECT_LE(most_apart(a, b), 1e-4) << name(shader);
  }
}

// A picture that rises linearly equals a hemisphere light: it has no higher bands, so a matt
// surface gathers 2/3 of the rise.
TEST(EnvironmentLights, ThatRiseAreAHemisphere) {
  const Look look;
  Image<Vec3> picture(128, 64);
  for (const auto& [x, y] : pixels(128, 64)) {
    const auto up = static_cast<float>(std::cos(std::numbers::pi * (y + 0.5) / 64));
    picture(x, y) = {0.5F + 0.45F * up, 0.5F, 0.5F - 0.45F * up};
  }
  Light hemisphere{.kind = HemisphereLight{{0, 1, 0}, {0.2F, 0.5F, 0.8F}},
                   .color = {0.8F, 0.5F, 0.2F}};
  const auto a = draw(look, lit_by({hemisphere}, Shader::lambert));
  const auto b = draw(look, lit_by({light_of(picture)}, Shader::lambert));
  EXPECT_LE(most_apart(a, b), 1.0 / 255);
}

// A quarter turn equals the picture with its columns moved by a quarter.
TEST(EnvironmentLights, TurnAboutTheirUp) {
  const Look look;
  const Image<Vec3> picture = small_environment(BuiltinEnvironment::room);
  Image<Vec3> moved(picture.width(), picture.height());
  for (const auto& [x, y] : pixels(picture.width(), picture.height()))
    moved(x, y) = picture((x + picture.width() / 4) % picture.width(), y);
  const Environment room(picture.view()), moved_room(moved.view());
  for (const Shader shader : {Shader::lambert, Shader::material}) {
    FrameOptions turned = lit_by({light_of(room, kQuarter)}, shader);
    FrameOptions of_moved = lit_by({light_of(moved_room)}, shader);
    turned.environment_behind = of_moved.environment_behind = true;
    EXPECT_LE(most_apart(draw(look, turned), draw(look, of_moved)), 0.02) << name(shader);
    EXPECT_GT(most_apart(draw(look, turned), draw(look, lit_by({light_of(room)}, shader))), 0.1);
  }
  // Nothing changes if the up direction and the camera turn together: +y to +x takes x to −y.
  const Look empty{{}, look.camera};
  Look rolled = empty;
  const auto roll = [](Vec3d v) { return Vec3d{v.y, -v.x, v.z}; };
  rolled.camera.eye = roll(look.camera.eye);
  rolled.camera.target = roll(look.camera.target);
  rolled.camera.up = roll(look.camera.up);
  FrameOptions behind = lit_by({light_of(room, 0.4F)}, Shader::flat);
  FrameOptions tilted = lit_by({light_of(room, 0.4F, {1, 0, 0})}, Shader::flat);
  behind.environment_behind = tilted.environment_behind = true;
  EXPECT_LE(most_apart(draw(empty, behind), draw(rolled, tilted)), 0.01);
}

TEST(EnvironmentLights, AreTheSameBitsForAllThatDraws) {
  const Look look;
  const Environment sky(small_environment(BuiltinEnvironment::sky).view());
  for (const Shader shader : {Shader::lambert, Shader::phong, Shader::material})
    for (const int samples : {1, 4}) {
      FrameOptions frame = lit_by({light_of(sky, 0.3F), headlight(0.2F)}, shader);
      frame.samples = samples;
      frame.environment_behind = true;
      if (samples == 4) frame.opacity = 0.6F;
      SCOPED_TRACE(testing::Message() << name(shader) << ", " << samples << " samples");
      EveryWay().same(
          [&](const RendererOptions& by) { return digest(draw(look, frame, by)).hex(); });
    }
}

TEST(EnvironmentLights, AreSeenBehindByTheirDirections) {
  // Four colours by quarters of the horizon, from −z on.
  Image<Vec3> picture(64, 32);
  const Vec3 quarters[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  for (const auto& [x, y] : pixels(64, 32)) picture(x, y) = quarters[(x + 40) / 16 % 4];
  FrameOptions frame = lit_by({light_of(picture)}, Shader::phong);
  frame.width = frame.height = 9;
  frame.environment_behind = true;
  const Vec3d ways[4] = {{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
  for (int i = 0; i < 4; ++i)
    for (const bool orthographic : {false, true}) {
      Camera camera{.eye = {5, 1, 2}};
      camera.target = camera.eye + ways[i];
      camera.orthographic = orthographic;
      if (orthographic) camera.far_plane = 10;
      const Frame f = test::draw({.threads = 1}, {}, camera, frame, kColor8);
      const Vec3 q = quarters[i];
      const auto byte = [](float v) { return static_cast<std::uint8_t>(v * 255); };
      EXPECT_EQ(f.color8(4, 4), (Rgba8{byte(q.x), byte(q.y), byte(q.z), 255})) << i;
    }
}

TEST(EnvironmentLights, BehindTakeTheTone) {
  FrameOptions frame = lit_by({light_of(constant({0.5F, 0.5F, 4}))}, Shader::material);
  frame.width = frame.height = 4;
  frame.environment_behind = true;
  frame.tone = {Tone::reinhard, 1};
  const Frame f = test::draw({.threads = 1}, {}, Camera{}, frame, kColor | kLinear);
  EXPECT_NEAR(f.color(1, 2).x, display(0.5), 1e-4);
  EXPECT_NEAR(f.color(1, 2).z, display(8.0 / 9), 1e-4);
  EXPECT_NEAR(f.linear(1, 2).z, 4, 1e-5);
  EXPECT_EQ(f.color(1, 2).w, 1);
}

TEST(EnvironmentLights, ThatCannotBeMeantAreRefused) {
  const Look look;
  const auto refused = [&](const char* part, const Light& light) {
    expect_refused(part, [&] { (void)draw(look, lit_by({light}, Shader::phong)); });
  };
  const Environment white(constant({1, 1, 1}).view());
  refused("light 0: its environment has no picture", {.kind = EnvironmentLight{}});
  refused("light 0: its up", light_of(white, 0, {0, 0, 0}));
  refused("light 0: its turn", light_of(white, NAN));
  FrameOptions behind = lit_by({headlight()}, Shader::phong);
  behind.environment_behind = true;
  expect_refused("no environment that could be seen behind", [&] { (void)draw(look, behind); });
  behind = lit_by({light_of(white)}, Shader::phong);
  behind.environment_behind = true;
  behind.width = behind.height = 4;
  Image<Rgba8> color8(4, 4);
  Image<float> depth(4, 4);
  const SceneBinding binding(look.scene);
  expect_refused("behind a whole picture", Errc::unsupported, [&] {
    Renderer({.threads = 1})
        .render(binding.view(), look.camera, behind, {.color8 = color8, .depth = depth},
                {.over = true});
  });
}

}  // namespace
}  // namespace rastrum::test::environment_light_test
