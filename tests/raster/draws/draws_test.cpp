// The draws of a frame: each is shaded and tested by what is its own, and what cannot be drawn is
// refused with its number.
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::draws_test {
namespace {

using raster::Draw;
using raster::Fragment;
using raster::VertexOutput;

constexpr int kWidth = 90, kHeight = 70;

RenderOptions options(Device device = Device::threads) {
  return RenderOptions({.width = kWidth, .height = kHeight, .background = {0.1F, 0.2F, 0.3F, 0.5F}},
                       {.device = device, .threads = 2});
}

/// The message of the Error that renderer.draw throws; "" if it throws none.
std::string message(std::span<Draw> draws, const raster::BlockShader& shader,
                    Device device = Device::threads) {
  try {
    Image<Rgba8> color(kWidth, kHeight);
    Targets targets{.color8 = color.view()};
    Painter(options(device)).draw(draws, shader, nullptr, targets);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    return e.what();
  }
  return "";
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

/// Two programs with varyings of their own, and one that is both, as it had to be written before.
struct Two {
  explicit Two(float alpha)
      : first(
            [](std::uint32_t i) {
              return VertexOutput<Scalar>{kFirst[i], first_varying(i)};
            },
            [alpha](const Scalar& v, const Fragment& f) {
              return std::array{first_color(v, alpha), Vec4{v.value, f.depth, 7, 1}};
            },
            [](const Scalar&, const Fragment& f) { return first_hole(f); }),
        second(
            [](std::uint32_t i) {
              return VertexOutput<Pair>{kSecond[i], second_varying(i)};
            },
            [alpha](const Pair& v, const Fragment&) { return second_color(v, alpha); },
            [](const Pair& v, const Fragment& f) { return second_hole(v, f); }),
        both(
            [](std::uint32_t i) {
              return i < 3 ? VertexOutput<Both>{kFirst[i], {first_varying(i), {}}}
                           : VertexOutput<Both>{kSecond[i - 3], {{}, second_varying(i - 3)}};
            },
            [alpha](const Both& v, const Fragment& f) {
              return f.draw % 2 == 0 ? std::array{first_color(v.first, alpha),
                                                  Vec4{v.first.value, f.depth, 7, 1}}
                                     : std::array{second_color(v.second, alpha), Vec4{0, 0, 0, 0}};
            },
            [](const Both& v, const Fragment& f) {
              return f.draw % 2 == 0 ? first_hole(f) : second_hole(v.second, f);
            }) {}

  struct Both {
    Scalar first;
    Pair second;
    Both operator+(const Both& o) const { return {first + o.first, second + o.second}; }
    Both operator*(float s) const { return {first * s, second * s}; }
  };
  template <class V, class S, class D>
  static raster::Program<V, S, D> program_of(V, S, D);
  using First = decltype(program_of(
      std::declval<VertexOutput<Scalar> (*)(std::uint32_t)>(),
      std::declval<std::function<std::array<Vec4, 2>(const Scalar&, const Fragment&)>>(),
      std::declval<bool (*)(const Scalar&, const Fragment&)>()));
  using Second =
      decltype(program_of(std::declval<VertexOutput<Pair> (*)(std::uint32_t)>(),
                          std::declval<std::function<Vec4(const Pair&, const Fragment&)>>(),
                          std::declval<bool (*)(const Pair&, const Fragment&)>()));
  using All = decltype(program_of(
      std::declval<VertexOutput<Both> (*)(std::uint32_t)>(),
      std::declval<std::function<std::array<Vec4, 2>(const Both&, const Fragment&)>>(),
      std::declval<bool (*)(const Both&, const Fragment&)>()));
  First first;
  Second second;
  All both;
};

struct WithExtra {
  Frame frame;
  Image<Vec4> extra{kWidth, kHeight};
};

template <class Draws>
WithExtra draw_all(const RenderOptions& o, Draws& draws, const raster::BlockShader& shader,
                   const raster::FragmentTest* test) {
  WithExtra w;
  w.frame.color8 = Image<Rgba8>(kWidth, kHeight);
  w.frame.color = Image<Vec4>(kWidth, kHeight);
  w.frame.depth = Image<float>(kWidth, kHeight);
  w.frame.ids = Image<std::int64_t>(kWidth, kHeight);
  w.frame.overdraw = Image<std::uint32_t>(kWidth, kHeight);
  Targets targets{.color8 = w.frame.color8,
                  .color = w.frame.color,
                  .depth = w.frame.depth,
                  .ids = w.frame.ids,
                  .overdraw = w.frame.overdraw};
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
        // The third is the first again, behind itself: it counts where something is blended.
        parts[2].depth_bias = whole[2].depth_bias = -0.1F;
        if (alpha < 1)
          for (Draw* const d : {parts.data(), whole.data()})
            for (int i = 0; i < 3; ++i) d[i].flags |= raster::kTranslucent;
        const WithExtra got = draw_all(o, parts, two.first, two.first.test());
        const WithExtra expected = draw_all(o, whole, two.both, two.both.test());
        ASSERT_TRUE(same_surfaces(got.frame, expected.frame));
        ASSERT_TRUE(same_picture(got.frame, expected.frame, 0));
        ASSERT_TRUE(same_counts(got.frame.stats, expected.frame.stats));
        int seen[4] = {};
        for (std::size_t i = 0; i < got.extra.pixels().size(); ++i) {
          const Vec4 a = got.extra.pixels()[i], b = expected.extra.pixels()[i];
          ASSERT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w) << i;
          ++seen[got.frame.ids.pixels()[i] + 1];
        }
        for (int i = 0; i < 3; ++i) EXPECT_GT(seen[i], 20);
      }
}

// A built-in shader finds its instances by the order of its own draws, whatever stands between.
TEST(Draws, MayHaveABuiltInShader) {
  Scene scene{.meshes = {shapes::sphere(12, 24), shapes::boxes(3)}};
  scene.meshes[1].colors.values.assign(scene.meshes[1].positions.size(), {0.2F, 0.9F, 0.3F, 1});
  scene.instances = {{0, Mat4d::identity()}, {1, Mat4d::identity()}};
  scene.instances[0].object_to_world.m[0][3] = 1.5;
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1, false);
  const Mat4d to_clip = world_to_clip(camera, kWidth, kHeight);
  std::vector<Draw> meshes;
  for (const InstanceView& instance : binding.view().instances) {
    Draw& d = meshes.emplace_back();
    d.source =
        raster::MatrixVertices(instance.mesh()->positions, to_clip * instance.object_to_world);
    d.vertex_count = instance.mesh()->positions.size();
    d.indices = instance.mesh()->indices.packed();
    d.primitive_count = instance.mesh()->triangle_count();
  }
  const Two two(1);
  for (const Device device : {Device::serial, Device::threads}) {
    RenderOptions o = options(device);
    o.shader = Shader::phong;
    const raster::LitScene lit_scene(binding.view(), camera, kWidth, kHeight);
    std::vector<Draw> draws{two.second.draw(3), meshes[0], two.first.draw(3), meshes[1], meshes[0]};
    draws[0].depth_bias = draws[2].depth_bias = -0.45F;
    draws[1].shading = draws[3].shading = raster::LitShading{Shader::phong, &lit_scene};
    draws[4].shading = raster::LitShading{Shader::normal, &lit_scene};
    // the lower half of the sphere again, before itself
    draws[4].depth_bias = 0.05F;
    draws[4].primitive_count /= 2;
    Painter renderer(o);
    const WithExtra mixed = draw_all(o, draws, two.first, two.first.test());
    const Frame lit = draw(renderer, binding.view(), camera);
    RenderOptions normals = o;
    normals.shader = Shader::normal;
    Painter of_normals(normals);
    const Frame with_normals = draw(of_normals, binding.view(), camera);
    std::array<Draw, 2> programs{two.first.draw(3), two.second.draw(3)};
    const WithExtra flat = draw_all(o, programs, two.first, two.first.test());
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
          // Where it is the nearest of the scene alone.
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
  const auto refused = [&](const std::string& what, auto&& change, Device device) {
    std::array<Draw, 2> draws{two.first.draw(3), two.first.draw(3)};
    change(draws[1]);
    const std::string text = message(draws, two.first, device);
    EXPECT_EQ(text.substr(0, 8), "draw 1: ") << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  const std::uint32_t indices[] = {0, 1, 2, 2, 1};
  for (const Device device : {Device::serial, Device::threads}) {
    refused(
        "source", [](Draw& d) { d.source = nullptr; }, device);
    refused(
        "primitive_count is 2", [](Draw& d) { d.primitive_count = 2; }, device);
    refused(
        "5 indices", [&](Draw& d) { d.indices = indices, d.primitive_count = 2; }, device);
    refused(
        "topology", [](Draw& d) { d.topology = raster::Topology{0}; }, device);
    refused(
        "line width", [](Draw& d) { d.line_width = -1; }, device);
    const std::uint32_t wrong[] = {0, 1, 17};
    refused(
        "index 17", [&](Draw& d) { d.indices = wrong; }, device);
  }
}

}  // namespace
}  // namespace rastrum::test::draws_test
