// SPDX-License-Identifier: BSD-3-Clause
// Cameras and clipping.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::picture_troubles {
namespace {

constexpr int kWidth = 120, kHeight = 90;

FrameOptions frame_of(Shader shader) {
  return FrameOptions{.width = kWidth, .height = kHeight, .shader = shader};
}

constexpr unsigned kKinds = kColor | kIds | kInstances;

Frame picture_of(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                 Device device = Device::threads) {
  static Renderer reference({.device = Device::serial}), fast({.threads = 1});
  return draw(device == Device::serial ? reference : fast, scene, camera, frame, kKinds);
}

// ── A floor of two triangles that reaches behind the eye.

Mesh floor_under_camera() {
  return Mesh{.positions = {{-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}},
              .indices = {0, 1, 2, 0, 2, 3}};
}

Camera over_floor() {
  return Camera{.eye = {0, 1, 3}, .target = {0, 0.5, 0}};
}

// A floor of two triangles that reaches behind the eye, with 4, 8 and 16 samples. Right: the
// bits of the serial reference (docs/conventions.md, Equal pictures).
TEST(OddClipping, CutTriangleIsTheReference) {
  const Mesh mesh = floor_under_camera();
  const OneInstance floor(mesh.view());
  const SceneView scene = floor.view();
  for (const int samples : {4, 8, 16})
    for (const Shader shader : {Shader::flat, Shader::phong, Shader::depth, Shader::wireframe}) {
      FrameOptions frame = frame_of(shader);
      frame.samples = samples;
      const Frame want = picture_of(scene, over_floor(), frame, Device::serial);
      EXPECT_GT(want.stats.pixels_covered, 0U);
      EXPECT_TRUE(same_images(picture_of(scene, over_floor(), frame), want, kColor | kIds))
          << samples << name(shader);
    }
}

// ── Mirrored instances and culling.

// Closed balls under matrices that mirror, and some that do not. Right: back faces are left
// out, and nothing else (docs/coverage.md: winding).
TEST(OddCulling, OfMirroredInstances) {
  const Mesh ball = shapes::sphere(8, 16);
  const std::vector<Material> materials{Material{.double_sided = false}};
  Camera camera{.eye = {0.5, 0.7, 5}};
  for (const Mat4d& transform :
       {scaling({-1, 1, 1}), scaling({-1, -1, -1}), scaling({1, 1, 1}), scaling({-1, -1, 1})})
    for (const Winding winding :
         {Winding::counter_clockwise, Winding::clockwise, Winding::either}) {
      Mesh mesh = ball;
      if (winding == Winding::clockwise)
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
          std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
      // Two in a row are one draw.
      const MeshView view = mesh.view();
      std::vector<InstanceView> balls(2, InstanceView{view, transform});
      balls[1].object_to_world = translation({1.5, 0, 0}) * transform;
      for (InstanceView& b : balls) b.winding = winding;
      for (const bool has_material : {false, true})
        for (const Device device : {Device::serial, Device::threads})
          for (int samples = 1; samples <= (test_share() < 100 ? 1 : 4); samples *= 4) {
            const SceneView scene{
                balls, has_material ? std::span(materials) : std::span<const Material>{}};
            FrameOptions frame = frame_of(has_material ? Shader::material : Shader::phong);
            frame.samples = samples;
            Material both;
            const SceneView from_both_sides{
                balls, has_material ? std::span<const Material>(&both, 1) : scene.materials};
            const Frame want = picture_of(from_both_sides, camera, frame, device);
            EXPECT_TRUE(same_images(picture_of(scene, camera, frame, device), want, kColor | kIds))
                << has_material;
            frame.cull = Cull::back;
            EXPECT_TRUE(same_images(picture_of(scene, camera, frame, device), want, kColor | kIds))
                << has_material;
            frame.cull = Cull::front;
            EXPECT_EQ(static_cast<bool>(same_images(picture_of(scene, camera, frame, device), want,
                                                    kColor | kIds)),
                      winding == Winding::either);
          }
    }
}

// ── Colours and what stands beside.

// A plain ball beside one with colours of its own. Right: the bits that it has alone
// (docs/colours.md: base colour).
TEST(OddColors, OfWhatStandsBeside) {
  const Mesh plain = shapes::sphere(24, 48);
  Mesh colored = plain;
  for (std::size_t i = 0; i < colored.positions.size(); ++i)
    colored.colors.values.push_back({0.25F, static_cast<float>(i % 7) / 7, 0.5F, 1});
  KeptInstances all;
  all.add(plain.view(), translation({-1.1, 0, 0}));
  all.add(colored.view(), translation({1.1, 0, 0}));
  Camera camera{.eye = {0.5, 0.7, 5}};
  for (const Shader shader : {Shader::flat, Shader::lambert, Shader::phong, Shader::wireframe})
    for (const Device device : {Device::serial, Device::threads})
      for (const int samples : {1, 4}) {
        FrameOptions frame = frame_of(shader);
        frame.samples = samples;
        const Frame alone = picture_of({{all.data(), 1}}, camera, frame, device);
        const Frame both = picture_of({all}, camera, frame, device);
        std::size_t differ = 0, seen = 0;
        for (std::size_t i = 0; i < alone.color.pixels().size(); ++i) {
          // No pixel has samples of both balls.
          if (alone.instances.pixels()[i] != 0) continue;
          ++seen;
          differ += !(alone.color.pixels()[i] == both.color.pixels()[i]);
        }
        EXPECT_GT(seen, 500U);
        EXPECT_EQ(differ, 0U) << name(shader) << ", samples " << samples;
      }
}

// ── Functions of the caller's that throw, or call their own renderer.

struct Nothing {
  Nothing operator+(Nothing) const { return {}; }
  Nothing operator*(float) const { return {}; }
};

enum class In : std::uint8_t { vertex, shade, discard };

/// Draws a triangle whose function `in` calls f; returns what that throws.
template <class F>
std::string thrown_in(In in, Renderer& renderer, const FrameOptions& frame, const F& f) {
  const Program program(
      [&](std::uint32_t i) {
        if (in == In::vertex) f();
        return VertexOutput<Nothing>{{i == 1 ? 3.0F : -1.0F, i == 2 ? 3.0F : -1.0F, 0.5F, 1}, {}};
      },
      [&](Nothing, const Fragment&) {
        if (in == In::shade) f();
        return Vec4{1, 1, 1, 1};
      },
      [&](Nothing, const Fragment&) {
        if (in == In::discard) f();
        return false;
      });
  Image<Vec4> color(frame.width, frame.height);
  const ProgramDraw draw = program.draw(3);
  try {
    renderer.draw({&draw, 1}, frame, {.color = color});
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

template <class Check>
void for_each_function(const Check& check) {
  for (const Device device : {Device::serial, Device::threads})
    for (const In in : {In::vertex, In::shade, In::discard})
      for (const int samples : {1, 4}) {
        Renderer renderer({.device = device, .threads = 2});
        FrameOptions frame = frame_of(Shader::flat);
        frame.samples = samples;
        check(in, renderer, frame);
        // It is as good as new.
        EXPECT_EQ(thrown_in(in, renderer, frame, [] {}), "");
      }
}

// A vertex function, shader or fragment test that throws. Right: the frame throws it, and the
// renderer remains usable (threads.md).
TEST(OddProgram, FunctionsThatThrow) {
  for_each_function([](In in, Renderer& renderer, const FrameOptions& frame) {
    EXPECT_EQ(thrown_in(in, renderer, frame, [] { throw std::runtime_error("of the caller"); }),
              "of the caller");
  });
}

// One that calls the renderer that draws its frame. Right: an error that says so (threads.md).
TEST(OddProgram, FunctionsThatDraw) {
  const Mesh mesh = floor_under_camera();
  const OneInstance floor(mesh.view());
  for_each_function([&](In in, Renderer& renderer, const FrameOptions& frame) {
    const std::string message = thrown_in(in, renderer, frame, [&] {
      Image<Vec4> color(8, 8);
      FrameOptions small{.width = 8, .height = 8};
      renderer.render(floor.view(), over_floor(), small, {.color = color});
    });
    EXPECT_NE(message.find("its own renderer"), std::string::npos) << message;
  });
}

}  // namespace

}  // namespace rastrum::test::picture_troubles
