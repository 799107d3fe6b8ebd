// SPDX-License-Identifier: BSD-3-Clause
// The plain shaders with materials: their base colour is the material's, as a display value. Also
// Shader::automatic, which takes `material` if there are materials.
#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::plain_shaders_test {
namespace {

constexpr int kSize = 64;

RenderOptions options(Shader shader) {
  return RenderOptions({.width = kSize, .height = kSize, .shader = shader}, {.threads = 2});
}

Material colored(Vec4 base) {
  return Material{.base_color = base, .double_sided = true};
}
Vec4 display_of(Vec4 base) {
  return {raster::srgb_from_linear(base.x), raster::srgb_from_linear(base.y),
          raster::srgb_from_linear(base.z), 1};
}

/// Colours the mesh's vertices, with `alpha` of their numbers.
void paint(Mesh& mesh, const auto& alpha) {
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
    mesh.colors.values.push_back({0.1F * static_cast<float>(i % 10), 0.5F, 1, alpha(i)});
}
void paint(Mesh& mesh) {
  paint(mesh, [](std::uint32_t) { return 1.0F; });
}

constexpr Vec4 kRed{0.6F, 0.02F, 0.001F, 1}, kBlue{0.1F, 0.2F, 0.9F, 1};

TEST(PlainShaders, HaveTheMaterialsColor) {
  Scene scene = single(quad(kSize, {0, 0}, {1, 1}));
  scene.materials = {colored(kRed), colored(kBlue)};
  scene.meshes[0].face_materials = {0, 1};
  const Frame frame = draw(options(Shader::flat), scene, pixel_camera(kSize, kSize));
  for (const auto& [y, base] : {std::pair{kSize - 4, kRed}, {3, kBlue}}) {
    const int x = y == 3 ? kSize - 4 : 3;
    const Rgba8 c = frame.color8(x, y);
    EXPECT_NEAR(c.r, 255 * display(static_cast<double>(base.x)), 0.6);
    EXPECT_NEAR(c.g, 255 * display(static_cast<double>(base.y)), 0.6);
    EXPECT_NEAR(c.b, 255 * display(static_cast<double>(base.z)), 0.6);
  }
}

/// A material's colour equals that of a mesh without materials but with such vertex colours.
TEST(PlainShaders, ShadeAMaterialAsVertexColors) {
  for (const bool has_colors : {false, true}) {
    Scene with, without;
    with.meshes = {shapes::sphere(12, 24), shapes::torus_knot(2, 3, 60, 8)};
    with.instances = {{0, Mat4d::identity()}, {1, Mat4d::identity()}};
    with.materials = {colored(kRed), colored(kBlue)};
    with.meshes[1].material = 1;
    if (has_colors) paint(with.meshes[0]);
    without = with;
    without.materials.clear();
    without.meshes[1].material = 0;
    for (std::size_t m = 0; m < 2; ++m) {
      const Vec4 base = display_of(with.materials[m].base_color);
      Mesh& mesh = without.meshes[m];
      if (mesh.colors.empty()) mesh.colors.values.assign(mesh.positions.size(), {1, 1, 1, 1});
      for (Vec4& c : mesh.colors.values) c = {base.x * c.x, base.y * c.y, base.z * c.z, 1};
    }
    const Camera camera = fit_camera(SceneBinding(with).view(), 1, false);
    for (const Shader shader : {Shader::flat, Shader::lambert, Shader::phong, Shader::wireframe})
      for (const RenderOptions& way : EveryWay(options(shader))) {
        const Frame a = draw(way, with, camera), b = draw(way, without, camera);
        // The scalar wireframe multiplies after it has interpolated.
        ASSERT_TRUE(same_picture(a, b, shader == Shader::wireframe ? 1 : 0))
            << name_of(way) << ", " << name(shader);
        ASSERT_GT(a.stats.pixels_covered, 500U);
      }
  }
}

/// A mesh without materials does not change beside one, out of sight, that has materials.
TEST(PlainShaders, HaveTheirOwnColorBesideMaterials) {
  for (const bool has_colors : {false, true}) {
    Scene alone = single(shapes::sphere(12, 24));
    if (has_colors)
      paint(alone.meshes[0], [](std::uint32_t i) { return i % 3 == 0 ? 0.5F : 1.0F; });
    Scene other = single(shapes::boxes(1));
    other.materials = {colored(kRed)};
    other.instances[0].object_to_world.m[2][3] = 1000;
    Scene before = alone, behind = other;
    before.append(other);
    behind.append(alone);
    const Camera camera = fit_camera(SceneBinding(alone).view(), 1, false);
    for (const Shader shader : {Shader::flat, Shader::lambert, Shader::phong, Shader::wireframe}) {
      const Frame expected = draw(options(shader), alone, camera);
      ASSERT_GT(expected.stats.pixels_covered, 500U);
      for (const Scene* scene : {&before, &behind})
        // The base colour is converted to linear light and back there.
        ASSERT_TRUE(same_picture(draw(options(shader), *scene, camera), expected, 1))
            << name(shader) << ", " << has_colors;
    }
  }
}

/// SIMD lanes of every instruction set equal plain C++, in float32: triangles cut by the near
/// plane, colours of vertices and copies, widths that are not a multiple of the lanes, several
/// samples.
TEST(PlainShaders, OfIdsLinesAndDepthsAreTheSameBitsInLanes) {
  Scene scene{.meshes = {shapes::torus_knot(2, 3, 40, 7), shapes::sphere(5, 9),
                         shapes::soup(30, 0.3F, 1.5F)}};
  paint(scene.meshes[1]);
  scene.instances = {{0, Mat4d::identity()}, {2, Mat4d::identity()}};
  for (int i = 0; i < 3; ++i) {  // copies of one mesh
    Mat4d place = Mat4d::identity();
    place.m[0][3] = i - 1.0;
    scene.instances.push_back({1, place});
  }
  const SceneBinding binding(scene);
  Camera camera = fit_camera(binding.view(), 1, false);
  camera.eye = camera.target + (camera.eye - camera.target) * 0.5;  // beyond the edges
  for (const bool cuts : {false, true}) {
    if (cuts) camera.near_plane = static_cast<float>(length(camera.target - camera.eye));
    for (const Shader shader : {Shader::id, Shader::wireframe, Shader::depth})
      for (const int samples : {1, 4}) {
        const FrameOptions o{.width = 61, .height = 45, .shader = shader, .samples = samples};
        SCOPED_TRACE(testing::Message()
                     << name(shader) << ", " << samples << (cuts ? " samples, cut" : " samples"));
        EveryWay({{.threads = 2}}).same([&](Renderer& renderer) {
          Frame f = draw(renderer, binding.view(), camera, o, kColor8 | kColor);
          EXPECT_GT(f.stats.pixels_covered, 500U);
          EXPECT_TRUE(!cuts || f.stats.triangles.clipped > 10) << f.stats.triangles.clipped;
          return f;
        });
      }
  }
}

TEST(PlainShaders, BlendTheMaterialsColorByItsAlpha) {
  Scene scene = single(quad(kSize, {0, 0}, {1, 1}));
  scene.materials = {colored({kBlue.x, kBlue.y, kBlue.z, 0.25F})};
  scene.materials[0].alpha_mode = AlphaMode::blend;
  RenderOptions o = options(Shader::flat);
  o.background = {0, 0, 0, 1};
  const Frame frame = EveryWay(o, {{.threads = 2}}).same([&](const RenderOptions& by) {
    return draw(by, scene, pixel_camera(kSize, kSize));
  });
  const Vec4 c = frame.color(9, 9), base = display_of(kBlue);
  EXPECT_NEAR(c.x, base.x / 4, 1e-6);
  EXPECT_NEAR(c.z, base.z / 4, 1e-6);
}

TEST(PlainShaders, AutomaticTakesMaterialWhereThereAreSome) {
  EXPECT_EQ(RenderOptions().shader, Shader::automatic);
  EXPECT_EQ(name(Shader::automatic), "auto");
  EXPECT_EQ(shader_from_name("auto"), Shader::automatic);
  const Camera camera = pixel_camera(kSize, kSize);
  Scene scene = single(quad(kSize, {0, 0}, {1, 1}));
  for (const Shader taken : {Shader::phong, Shader::material}) {
    if (taken == Shader::material) scene.materials = {colored(kRed)};
    EXPECT_EQ(shader_for(Shader::automatic, SceneBinding(scene).view()), taken);
    EXPECT_EQ(shader_for(Shader::id, SceneBinding(scene).view()), Shader::id);
    const Frame automatic = draw(options(Shader::automatic), scene, camera);
    const Frame asked = draw(options(taken), scene, camera);
    EXPECT_EQ(automatic.stats.shader, name(taken));
    EXPECT_EQ(asked.stats.shader, name(taken));
    EXPECT_TRUE(same_images(automatic, asked));
  }
}

}  // namespace
}  // namespace rastrum::test::plain_shaders_test
