// SPDX-License-Identifier: BSD-3-Clause
// The draws of a frame: each has its own shader and test, and errors name the draw's number.
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/draws_of.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::draws_test {
namespace {
using raster::Draw;

constexpr int kWidth = 90, kHeight = 70;

RenderOptions options(Device device = Device::threads) {
  return RenderOptions({.width = kWidth, .height = kHeight, .background = {0.1F, 0.2F, 0.3F, 0.5F}},
                       {.device = device, .threads = 2});
}

struct Scalar {
  float value = 0;
  Scalar operator+(const Scalar& o) const { return {value + o.value}; }
  Scalar operator*(float s) const { return {value * s}; }
};
struct Pair {
  Vec3 a;
  float b = 0;
  Pair operator+(const Pair& o) const { return {a + o.a, b + o.b}; }
  Pair operator*(float s) const { return {a * s, b * s}; }
};

constexpr Vec4 kFirst[] = {{-0.9F, -0.8F, 0.5F, 1}, {0.9F, -0.9F, 0.2F, 1}, {0, 0.9F, 0.7F, 1}};
constexpr Vec4 kSecond[] = {{-0.9F, 0.8F, 0.3F, 1}, {0.1F, -0.9F, 0.6F, 1}, {0.9F, 0.9F, 0.5F, 1}};

Scalar first_varying(std::uint32_t i) {
  return {0.2F + 0.3F * static_cast<float>(i)};
}
Pair second_varying(std::uint32_t i) {
  return {{i == 0 ? 1.0F : 0, i == 1 ? 1.0F : 0, 0.5F}, static_cast<float>(i)};
}
Vec4 first_color(const Scalar& v, float alpha) {
  return Vec4{v.value, 0.1F, 0, 1} * alpha;
}
Vec4 second_color(const Pair& v, float alpha) {
  return Vec4{v.a.x, v.a.y, v.a.z, 1} * alpha;
}
bool first_hole(const Fragment& f) {
  return f.x % 8 == 0;
}
bool second_hole(const Pair& v, const Fragment& f) {
  return v.b > 1.2F && f.y % 4 == 0;
}

/// The varyings of Two::both.
struct Both {
  Scalar first;
  Pair second;
  Both operator+(const Both& o) const { return {first + o.first, second + o.second}; }
  Both operator*(float s) const { return {first * s, second * s}; }
};

auto first_program(float alpha) {
  return Program(
      [](std::uint32_t i) {
        return VertexOutput<Scalar>{kFirst[i], first_varying(i)};
      },
      [alpha](const Scalar& v, const Fragment& f) {
        return std::array{first_color(v, alpha), Vec4{v.value, f.depth, 7, 1}};
      },
      [](const Scalar&, const Fragment& f) { return first_hole(f); });
}
auto second_program(float alpha) {
  return Program(
      [](std::uint32_t i) {
        return VertexOutput<Pair>{kSecond[i], second_varying(i)};
      },
      [alpha](const Pair& v, const Fragment&) { return second_color(v, alpha); },
      [](const Pair& v, const Fragment& f) { return second_hole(v, f); });
}
auto program_of_both(float alpha) {
  return Program(
      [](std::uint32_t i) {
        return i < 3 ? VertexOutput<Both>{kFirst[i], {first_varying(i), {}}}
                     : VertexOutput<Both>{kSecond[i - 3], {{}, second_varying(i - 3)}};
      },
      [alpha](const Both& v, const Fragment& f) {
        return f.draw % 2 == 0
                   ? std::array{first_color(v.first, alpha), Vec4{v.first.value, f.depth, 7, 1}}
                   : std::array{second_color(v.second, alpha), Vec4{0, 0, 0, 0}};
      },
      [](const Both& v, const Fragment& f) {
        return f.draw % 2 == 0 ? first_hole(f) : second_hole(v.second, f);
      });
}

/// Two programs with their own varyings, and one program that combines them.
struct Two {
  explicit Two(float alpha)
      : first(first_program(alpha)), second(second_program(alpha)), both(program_of_both(alpha)) {}
  decltype(first_program(1)) first;
  decltype(second_program(1)) second;
  decltype(program_of_both(1)) both;
};

struct WithExtra {
  Frame frame;
  Image<Vec4> extra{kWidth, kHeight};
};

template <class Draws>
WithExtra draw_all(const RenderOptions& o, Draws& draws, const raster::Shading& shader,
                   const raster::Testing& test) {
  WithExtra w;
  w.frame = Frame(kWidth, kHeight, kCounted);
  Targets targets = w.frame.targets();
  const std::array extra{w.extra.view()};
  targets.extra = extra;
  w.frame.stats = Painter(o).draw(draws, shader, test, targets);
  return w;
}

TEST(Draws, AreShadedAndTestedEachByItsProgram) {
  std::vector<RenderOptions> ways{options(Device::serial), options()};
  for (const family::AxisInfo& v : family::visibility_axis()) {
    ways.push_back(options());
    ways.back().visibility = v.name;
  }
  for (const float alpha : {1.0F, 0.4F})
    for (const int samples : {1, 4})
      for (RenderOptions o : ways) {
        if (o.visibility != "auto" && (alpha < 1 || samples > 1)) continue;
        o.samples = samples;
        SCOPED_TRACE(std::string(name(o.device)) + " " + o.visibility + " " +
                     std::to_string(alpha) + " " + std::to_string(samples));
        const Two two(alpha);
        std::array<Draw, 3> parts{two.first.draw(3), two.second.draw(3), two.first.draw(3)};
        const std::uint32_t indices[] = {3, 4, 5};
        std::array<Draw, 3> whole{two.both.draw(6), two.both.draw(6, indices), two.both.draw(6)};
        whole[0].primitive_count = whole[2].primitive_count = 1;
        // The third is the first again, slightly behind: it counts where something is blended.
        parts[2].depth_bias = whole[2].depth_bias = -0.1F;
        if (alpha < 1)
          for (Draw* const d : {parts.data(), whole.data()})
            for (int i = 0; i < 3; ++i) d[i].flags |= kTranslucent;
        const WithExtra got = draw_all(o, parts, two.first, two.first);
        const WithExtra expected = draw_all(o, whole, two.both, two.both);
        ASSERT_TRUE(same_images(got.frame, expected.frame));
        ASSERT_TRUE(same_counts(got.frame.stats, expected.frame.stats));
        int seen[4] = {};
        for (std::size_t i = 0; i < got.extra.pixels().size(); ++i) {
          ASSERT_EQ(got.extra.pixels()[i], expected.extra.pixels()[i]) << i;
          ++seen[got.frame.ids.pixels()[i] + 1];
        }
        for (int i = 0; i < 3; ++i) EXPECT_GT(seen[i], 20);
      }
}

// A built-in shader finds its instances by the order of its own draws, among any others.
TEST(Draws, MayHaveABuiltInShader) {
  Scene scene{.meshes = {shapes::sphere(12, 24), shapes::boxes(3)}};
  scene.meshes[1].colors.values.assign(scene.meshes[1].positions.size(), {0.2F, 0.9F, 0.3F, 1});
  scene.instances = {{0, Mat4d::identity()}, {1, Mat4d::identity()}};
  scene.instances[0].object_to_world.m[0][3] = 1.5;
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1, false);
  const std::vector<Draw> meshes = draws_of(binding.view(), world_to_clip(camera, kWidth, kHeight));
  const Two two(1);
  for (const Device device : {Device::serial, Device::threads}) {
    RenderOptions o = options(device);
    o.shader = Shader::phong;
    const raster::LitScene lit_scene(binding.view(), camera, kWidth, kHeight);
    std::vector<Draw> draws{two.second.draw(3), meshes[0], two.first.draw(3), meshes[1], meshes[0]};
    draws[0].depth_bias = draws[2].depth_bias = -0.45F;
    draws[1].shading = draws[3].shading = raster::LitShading{Shader::phong, &lit_scene};
    draws[4].shading = raster::LitShading{Shader::normal, &lit_scene};
    // the lower half of the sphere again, slightly in front
    draws[4].depth_bias = 0.05F;
    draws[4].primitive_count /= 2;
    const WithExtra mixed = draw_all(o, draws, two.first, two.first);
    const Frame lit = draw(o, scene, camera);
    o.shader = Shader::normal;
    const Frame with_normals = draw(o, scene, camera);
    std::array<Draw, 2> programs{two.first.draw(3), two.second.draw(3)};
    const WithExtra flat = draw_all(o, programs, two.first, two.first);
    int seen[5] = {};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::int64_t id = mixed.frame.ids(x, y);
        if (id < 0) continue;
        std::size_t which = 0;
        for (std::uint64_t end = draws[0].primitive_count; static_cast<std::uint64_t>(id) >= end;)
          end += draws[++which].primitive_count;
        ++seen[which];
        const Rgba8 c = mixed.frame.color8(x, y);
        const bool is_sphere = lit.ids(x, y) < static_cast<std::int64_t>(meshes[0].primitive_count);
        if (which == 4 || which % 2 == 1) {
          // Where it is also the nearest in the scene alone.
          if (is_sphere == (which != 3)) {
            EXPECT_EQ(c, (which == 4 ? with_normals : lit).color8(x, y)) << x << ", " << y;
          }
        } else if (flat.frame.ids(x, y) == (which == 2 ? 0 : 1)) {
          EXPECT_EQ(c, flat.frame.color8(x, y)) << x << ", " << y;
        }
      }
    for (const int n : seen) EXPECT_GT(n, 20);
  }
}

TEST(Draws, ThatCannotBeDrawnAreRefusedByNumber) {
  const Two two(1);
  const std::uint32_t indices[] = {0, 1, 2, 2, 1}, wrong[] = {0, 1, 17};
  const std::pair<const char*, std::function<void(Draw&)>> changes[] = {
      {"source", [](Draw& d) { d.source = nullptr; }},
      {"primitive_count is 2", [](Draw& d) { d.primitive_count = 2; }},
      {"5 indices", [&](Draw& d) { d.indices = indices, d.primitive_count = 2; }},
      {"topology", [](Draw& d) { d.topology = Topology{0}; }},
      {"line width", [](Draw& d) { d.line_width = -1; }},
      {"index 17", [&](Draw& d) { d.indices = wrong; }}};
  for (const Device device : {Device::serial, Device::threads})
    for (const auto& [what, change] : changes) {
      std::array<Draw, 2> draws{two.first.draw(3), two.first.draw(3)};
      change(draws[1]);
      Painter painter(options(device));
      const std::string said = refusal_of([&] { (void)draw(painter, draws, two.first, nullptr); });
      EXPECT_TRUE(said.starts_with("draw 1: ") && holds(said, what)) << what << " in: " << said;
    }
}

}  // namespace
}  // namespace rastrum::test::draws_test
