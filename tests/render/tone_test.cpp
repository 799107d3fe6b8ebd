// SPDX-License-Identifier: BSD-3-Clause
// Tone mapping: its formulas in float64, the same bits everywhere, and what it leaves alone.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/colors.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::tone_test {
namespace {

constexpr int kW = 96, kH = 72;

/// A ball from black to far brighter than white, in front of a background that is not black.
struct Bright {
  Mesh ball = shapes::sphere(24, 24);
  std::vector<Material> materials{Material{}};
  KeptInstances instances{ball.view()};
  FrameOptions frame{.width = kW,
                     .height = kH,
                     .shader = Shader::material,
                     .background = {0.2F, 0.3F, 0.4F, 0.5F}};

  Bright() {
    materials[0].base_color = {0.9F, 0.6F, 0.2F, 1};
    frame.lights = {{.kind = DirectionalLight{{1, -1, -1}}, .intensity = 12}};
  }
  [[nodiscard]] Frame draw(const ToneMapping& tone, RendererOptions by = {.threads = 2},
                           int samples = 1) const {
    FrameOptions look = frame;
    look.tone = tone;
    look.samples = samples;
    Camera camera{.eye = {0, 0, 3}};
    return test::draw(by, {instances, materials, {}}, camera, look,
                      kColor8 | kColor | kDepth | kLinear);
  }
};

/// The specifications' formulas.
void map(Tone tone, double (&c)[3]) {
  if (tone == Tone::reinhard)
    for (double& x : c) x = x / (1 + x);
  if (tone == Tone::aces)
    for (double& x : c) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  if (tone != Tone::neutral) return;
  const double least = std::min({c[0], c[1], c[2]});
  const double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
  for (double& x : c) x -= offset;
  const double peak = std::max({c[0], c[1], c[2]}), start = 0.8 - 0.04;
  if (peak < start) return;
  const double now = 1 - (1 - start) * (1 - start) / (peak + 1 - start - start);
  const double g = 1 - 1 / (0.15 * (peak - now) + 1);
  for (double& x : c) x = x * now / peak * (1 - g) + now * g;
}

TEST(ToneMapping, IsItsFormula) {
  const Bright bright;
  for (const Tone tone : {Tone::none, Tone::reinhard, Tone::aces, Tone::neutral})
    for (const float stops : {0.0F, -2.5F, 3.0F}) {
      const ToneMapping how{tone, stops};
      if (how == ToneMapping{}) continue;
      SCOPED_TRACE(std::to_string(static_cast<int>(tone)) + ", " + std::to_string(stops));
      const Frame p = bright.draw(how);
      int seen = 0, above_white = 0;
      double most = 0;
      for (const auto& [x, y] : pixels(kW, kH)) {
        if (p.depth(x, y) == 0) {
          EXPECT_EQ(p.color(x, y), (Vec4{0.1F, 0.15F, 0.2F, 0.5F}));
          continue;
        }
        ++seen;
        const Vec4 l = p.linear(x, y);
        double c[3] = {l.x, l.y, l.z};
        for (double& channel : c) channel = channel / double{l.w} * std::exp2(double{stops});
        above_white += std::max({c[0], c[1], c[2]}) > 1 ? 1 : 0;
        map(tone, c);
        const float got[3] = {p.color(x, y).x, p.color(x, y).y, p.color(x, y).z};
        const std::uint8_t got8[3] = {p.color8(x, y).r, p.color8(x, y).g, p.color8(x, y).b};
        for (int i = 0; i < 3; ++i) {
          most = std::max(most, std::abs(display(c[i]) - double{got[i]}));
          EXPECT_EQ(got8[i], static_cast<std::uint8_t>(got[i] * 255 + 0.5F));
        }
      }
      EXPECT_GT(seen, kW * kH / 5);
      if (stops >= 0) {
        EXPECT_GT(above_white, seen / 10);
      }
      EXPECT_LT(most, 2e-4);
    }
}

TEST(ToneMapping, IsTheSameForEveryone) {
  const Bright bright;
  for (const int samples : {1, 4})
    for (const Tone tone : {Tone::reinhard, Tone::neutral}) {
      const ToneMapping how{tone, 0.5F};
      EveryWay().same([&](const RendererOptions& by) { return bright.draw(how, by, samples); });
    }
}

TEST(ToneMapping, LeavesTheOtherImages) {
  const Bright bright;
  const Frame plain = bright.draw({}), mapped = bright.draw({Tone::aces, 1});
  EXPECT_TRUE(same_images(plain, mapped, kLinear | kDepth));
  EXPECT_FALSE(same_images(plain, mapped, kColor8));
}

TEST(ToneMapping, RefusesWhatItIsNotOf) {
  const Bright bright;
  const auto message = [&](const ToneMapping& tone, Shader shader = Shader::material,
                           int width = kW) {
    Image<Rgba8> color8(width, kH);
    FrameOptions frame = bright.frame;
    frame.tone = tone;
    frame.shader = shader;
    const SceneView scene{bright.instances, bright.materials, {}};
    return error_message_of(
        [&] { Renderer({.threads = 1}).render(scene, {}, frame, {.color8 = color8}); });
  };
  const ToneMapping aces{Tone::aces, 0};
  EXPECT_EQ(message(aces), "");
  EXPECT_TRUE(holds(message(aces, Shader::material, kW / 2), "48x72"));
  EXPECT_TRUE(holds(message(aces, Shader::phong), "'material'"));
  for (const float stops : {33.0F, -33.0F, std::nanf("")})
    EXPECT_TRUE(holds(message({Tone::none, stops}), "exposure"));
  EXPECT_TRUE(holds(message({static_cast<Tone>(9), 0}), "tone"));
}

}  // namespace
}  // namespace rastrum::test::tone_test
