// SPDX-License-Identifier: BSD-3-Clause
// The sources of alpha with every shader: opacity, materials, textures, vertex colours; and how a
// translucent picture is stored. The expected colours are computed again in float64.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/render.hpp>

#include "tests/support/draws_of.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::alpha_test {
namespace {

constexpr int kSize = 24;  // 3 blocks of 8

RenderOptions options(Shader shader, float opacity = 1) {
  return RenderOptions({.width = kSize,
                        .height = kSize,
                        .shader = shader,
                        .background = {0.2F, 0.6F, 1, 0.5F},
                        .opacity = opacity},
                       {.threads = 2});
}

Frame frame_of(const RenderOptions& o, const Scene& scene) {
  return draw(o, scene, pixel_camera(kSize, kSize));
}

/// A coloured quad; the materials decide what is drawn.
Scene quad_scene(double depth = 0.5) {
  return single(quad(kSize, {0, 0}, {1, 1}, depth));
}

/// The display value of a surface with `alpha` over the background, blended in the shader's light.
double over(double front, double alpha, double back, double back_alpha, bool linear) {
  if (linear) front = light_of(front), back = light_of(back);
  const double a = alpha + back_alpha * (1 - alpha);
  const double straight = (front * alpha + back * back_alpha * (1 - alpha)) / a;
  return linear ? display(straight) : straight;
}

/// The straight colour of pixel (x, y).
Vec4 straight(const Frame& frame, int x, int y) {
  const Vec4 c = frame.color(x, y);
  return {c.x / c.w, c.y / c.w, c.z / c.w, c.w};
}

/// Draws on every instruction set and on the serial device, expects equal frames, and returns the
/// first.
Frame frame_of_all(const RenderOptions& o, const Scene& scene) {
  return EveryWay(o).same([&](const RenderOptions& by) { return frame_of(by, scene); });
}

/// Expects that all pixels of `frame` are `opaque`'s with `alpha` over the background.
void expect_over(const Frame& frame, const Frame& opaque, double alpha, const RenderOptions& o) {
  const Vec4 b = o.background;
  const bool linear = o.shader == Shader::material;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Vec4 front = opaque.color(x, y), got = straight(frame, x, y);
      ASSERT_EQ(front.w, 1);
      ASSERT_NEAR(got.w, alpha + b.w * (1 - alpha), 1e-6);
      // The transfer function is accurate to 3.2e-5; its inverse here is exact.
      const double tolerance = linear ? 3e-4 : 1e-6;
      ASSERT_NEAR(got.x, over(front.x, alpha, b.x, b.w, linear), tolerance) << x << ", " << y;
      ASSERT_NEAR(got.y, over(front.y, alpha, b.y, b.w, linear), tolerance) << x << ", " << y;
      ASSERT_NEAR(got.z, over(front.z, alpha, b.z, b.w, linear), tolerance) << x << ", " << y;
    }
}

class EveryShader : public testing::TestWithParam<Shader> {};

TEST_P(EveryShader, OpacityIsBlendedOverTheBackground) {
  Scene scene = quad_scene();
  scene.meshes[0].colors.values = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0.2F, 1, 1}, {0.5F, 0.5F, 0, 1}};
  const Frame opaque = frame_of(options(GetParam()), scene);
  EXPECT_EQ(opaque.stats.visibility, "atomic");
  for (const float opacity : {0.0F, 0.25F, 0.9F}) {
    const RenderOptions o = options(GetParam(), opacity);
    const Frame frame = frame_of_all(o, scene);
    EXPECT_EQ(frame.stats.visibility, "layers");
    EXPECT_TRUE(same_images(frame, opaque, kVisible));
    expect_over(frame, opaque, opacity, o);
  }
  RenderOptions none = options(GetParam(), 0.25F);
  none.transparency.method = Transparency::none;
  const Frame unblended = frame_of(none, scene);
  EXPECT_EQ(unblended.stats.visibility, "atomic");
  EXPECT_TRUE(std::ranges::equal(unblended.color8.pixels(), opaque.color8.pixels()));
}

/// OPAQUE, MASK and BLEND at once, on a mesh's two triangles, with alpha's factors.
TEST_P(EveryShader, EachMaterialHasItsAlpha) {
  const float own = 0.7F * (204 / 255.0F) * 0.9F * (51 / 255.0F);
  const auto scene_with = [&](AlphaMode first, AlphaMode second, float cutoff) {
    Scene scene = quad_scene();
    scene.textures.push_back(texture(4, 4, [](int, int) { return Rgba8{250, 99, 9, 204}; }));
    scene.textures.push_back(texture(4, 4, [](int, int) { return Rgba8{51, 0, 0, 9}; }));
    scene.meshes[0].colors.values.assign(4, {1, 1, 1, 0.9F});
    scene.meshes[0].face_materials = {0, 1};
    for (const AlphaMode mode : {first, second}) {
      Material& m = scene.materials.emplace_back();
      m.base_color = {0.5F, 1, 1, 0.7F};
      m.base_color_texture = 0;
      m.alpha_texture = 1;
      m.alpha_mode = mode;
      m.alpha_cutoff = cutoff;
    }
    return scene;
  };
  const auto opaque_mode = AlphaMode::opaque, blend = AlphaMode::blend, mask = AlphaMode::mask;
  const Frame plain = frame_of(options(GetParam()), scene_with(opaque_mode, opaque_mode, 0));
  for (const float opacity : {1.0F, 0.5F}) {
    const RenderOptions o = options(GetParam(), opacity);
    expect_over(frame_of(o, scene_with(opaque_mode, opaque_mode, 0)), plain, opacity, o);
    expect_over(frame_of_all(o, scene_with(blend, blend, 0)), plain, opacity * own, o);
    expect_over(frame_of_all(o, scene_with(mask, mask, own * 0.999F)), plain, opacity, o);
    EXPECT_EQ(frame_of(o, scene_with(mask, mask, own * 1.001F)).stats.pixels_covered, 0U);

    // Two kinds in one mesh: each triangle as if alone.
    const Frame mixed = frame_of_all(o, scene_with(blend, opaque_mode, 0));
    const Frame one = frame_of(o, scene_with(blend, blend, 0)),
                other = frame_of(o, scene_with(opaque_mode, opaque_mode, 0));
    ASSERT_TRUE(pixels_are(mixed.color8, [&](int x, int y) {
      return (mixed.ids(x, y) == 0 ? one : other).color8(x, y);
    }));
    EXPECT_EQ(mixed.stats.visibility, "layers");
  }
}

TEST_P(EveryShader, OpaqueSurfacesKeepTheirBitsBesideTranslucentOnes) {
  Scene scene = quad_scene();
  scene.meshes[0].colors.values = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0.2F, 1, 1}, {0.5F, 0.5F, 0, 1}};
  scene.meshes[0].face_materials = {0, 1};
  scene.materials.resize(2);
  const Frame opaque = frame_of(options(GetParam()), scene);
  scene.materials[1].alpha_mode = AlphaMode::blend;
  scene.materials[1].base_color.w = 0.5F;
  const Frame frame = frame_of(options(GetParam()), scene);
  int kept = 0, different = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (opaque.ids(x, y) == 0) {
        ASSERT_EQ(frame.color8(x, y), opaque.color8(x, y)) << x << ", " << y;
        ASSERT_EQ(frame.color(x, y), opaque.color(x, y)) << x << ", " << y;
        ++kept;
      } else {
        different += frame.color8(x, y) != opaque.color8(x, y);
      }
  EXPECT_GT(kept, 200);
  EXPECT_GT(different, 200);
}

std::vector<Shader> blending_shaders() {
  std::vector<Shader> shaders;
  for (const std::string_view n : shader_names())
    if (n != "depth" && n != "auto")  // "auto" is one of the others
      shaders.push_back(shader_from_name(n));
  return shaders;
}
INSTANTIATE_TEST_SUITE_P(Shaders, EveryShader, testing::ValuesIn(blending_shaders()),
                         [](const auto& p) { return std::string(name(p.param)); });

TEST(Alpha, VertexColoursOfScenesWithoutMaterialsBlend) {
  for (const Shader shader : {Shader::flat, Shader::material}) {
    Scene scene = quad_scene();
    scene.meshes[0].colors.values.assign(4, {0.5F, 1, 0.25F, 1});
    const Frame opaque = frame_of(options(shader), scene);
    EXPECT_EQ(opaque.stats.visibility, "atomic");
    // Alpha rises from the left to the right.
    for (const std::size_t i : {0U, 3U}) scene.meshes[0].colors.values[i].w = 0;
    for (const float opacity : {1.0F, 0.5F}) {
      const RenderOptions o = options(shader, opacity);
      const Frame frame = frame_of(o, scene);
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double alpha = static_cast<double>(opacity) * (x + 0.5) / kSize;
          const double front = opaque.color(x, y).x;
          ASSERT_NEAR(straight(frame, x, y).w, alpha + 0.5 * (1 - alpha), 1e-6);
          ASSERT_NEAR(straight(frame, x, y).x,
                      over(front, alpha, 0.2F, 0.5, shader == Shader::material), 3e-4);
        }
    }
    // A material decides whether vertex alpha counts.
    scene.materials.emplace_back();
    EXPECT_EQ(frame_of(options(shader), scene).stats.visibility, "atomic");
  }
}

TEST(Alpha, NonsenseIsClamped) {
  const auto alpha_of = [](float vertex_alpha) {
    Scene scene = quad_scene();
    scene.meshes[0].colors.values.assign(4, {1, 1, 1, vertex_alpha});
    RenderOptions o = options(Shader::flat);
    o.background = {};
    const Frame frame = frame_of(o, scene);
    return frame.color(5, 7).w;
  };
  EXPECT_EQ(alpha_of(NAN), 0);
  EXPECT_EQ(alpha_of(-3), 0);
  EXPECT_EQ(alpha_of(7), 1);
  EXPECT_EQ(alpha_of(INFINITY), 1);
}

TEST(Alpha, OneTranslucentVertexOfManyIsFound) {
  for (const std::size_t at : {0UL, 16383UL, 16384UL, 40000UL, 49999UL}) {
    Scene scene = quad_scene();
    scene.meshes[0].positions.resize(50000);
    scene.meshes[0].texcoords = {};
    scene.meshes[0].colors.values.assign(50000, {1, 1, 1, 1});
    EXPECT_EQ(frame_of(options(Shader::flat), scene).stats.visibility, "atomic");
    scene.meshes[0].colors.values[at].w = 0.5F;
    EXPECT_EQ(frame_of(options(Shader::flat), scene).stats.visibility, "layers") << at;
  }
}

TEST(Alpha, LayersBlendFrontToBackInTheLightOfTheShader) {
  for (const Shader shader : {Shader::flat, Shader::material}) {
    Scene scene = unlit(quad(kSize, {0, 0}, {1, 1}, 0.75), texture(1, 1, [](int, int) {
                          return Rgba8{230, 40, 120, 255};
                        }));
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.4F;
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].base_color = {0.1F, 1, 0.5F, 0.7F};
    scene.materials[1].base_color_texture = kNoTexture;
    scene.meshes.push_back(quad(kSize, {0, 0}, {1, 1}, 0.25));
    scene.meshes[1].material = 1;
    scene.instances.insert(scene.instances.begin(), {1, Mat4d::identity()});  // the farther first
    const RenderOptions o = options(shader);
    const Frame frame = frame_of(o, scene);
    const bool linear = shader == Shader::material;
    // Only the material shader uses textures.
    const double front = linear ? 230 / 255.0 : 1, middle = display(0.1);
    const double behind = over(middle, 0.7, 0.2, 0.5, linear);
    const double behind_alpha = 0.7 + 0.5 * 0.3;
    EXPECT_NEAR(straight(frame, 9, 9).x, over(front, 0.4, behind, behind_alpha, linear), 3e-4);
    EXPECT_NEAR(straight(frame, 9, 9).w, 0.4 + behind_alpha * 0.6, 1e-6);
    EXPECT_EQ(frame.ids(9, 9) / 2, 1) << "the nearer one";
    EXPECT_EQ(frame.color8(9, 9).r,
              std::lround(255 * over(front, 0.4, behind, behind_alpha, linear)));
  }
}

TEST(Alpha, TheDepthPictureIsOfTheNearestSurfaceWhateverItsOpacity) {
  Scene scene = quad_scene();
  const Frame opaque = frame_of(options(Shader::depth), scene);
  const Frame frame = frame_of(options(Shader::depth, 0.25F), scene);
  EXPECT_TRUE(std::ranges::equal(frame.color8.pixels(), opaque.color8.pixels()));
}

/// A user's shader returns alpha, and its draws are marked translucent.
TEST(Alpha, UsersShadersBlendByTheirOwn) {
  const Mesh mesh = quad(kSize, {0, 0}, {1, 1});
  const raster::FragmentShader shader([](const raster::FrameGeometry&, const Fragment&) {
    return Vec4{0.25F, 0, 0.5F, 0.5F};
  });
  raster::Draw d = draw_of(mesh.positions, world_to_clip(pixel_camera(kSize, kSize), kSize, kSize));
  d.indices = mesh.indices;
  d.primitive_count = 2;
  d.flags = kTranslucent;
  for (const std::string rasterizer : {"grouped", "tiled"}) {
    std::vector<raster::Draw> twice{d, d};
    RenderOptions o = options(Shader::flat);
    o.background = {};
    o.rasterizer = rasterizer;
    Painter renderer(o);
    const Frame frame = draw(renderer, twice, shader, nullptr);
    for (const Vec4 c : frame.color.pixels()) ASSERT_EQ(c, (Vec4{0.375F, 0, 0.75F, 0.75F}));
    // By material, for one triangle only.
    const std::vector<std::uint32_t> flags{0, kTranslucent}, materials{0, 1};
    twice[1].flags = 0;
    twice[1].face_materials = materials;
    twice[1].material_flags = flags;
    const Frame half = draw(renderer, twice, shader, nullptr);
    EXPECT_EQ(half.color(20, 5), (Vec4{0.375F, 0, 0.75F, 0.75F}));
    EXPECT_EQ(half.color(4, 20), (Vec4{0.375F, 0, 0.75F, 0.75F}));
    // Drawn opaque if nothing may blend, micro fragments included.
    o.transparency.method = Transparency::none;
    Painter none(o);
    const Frame front = draw(none, twice, shader, nullptr);
    EXPECT_EQ(front.color(5, 5), (Vec4{0.25F, 0, 0.5F, 0.5F}));
  }
}

void refused(const RenderOptions& o) {
  expect_refused("", [&] { (void)frame_of(o, quad_scene()); });
}

TEST(Alpha, OptionsOutOfRangeAreRefused) {
  const auto with = [](const auto& change) {
    RenderOptions o = options(Shader::flat);
    change(o);
    refused(o);
  };
  for (const float a : {-0.1F, 1.1F, NAN}) with([&](RenderOptions& o) { o.opacity = a; });
  for (const float a : {-0.1F, 0.0F, 1.1F, NAN})
    with([&](RenderOptions& o) { o.transparency.alpha_threshold = a; });
  for (const int n : {0, 65, -1}) EXPECT_THROW((void)family::filtered(n), Error);
  for (const int n : {0, 2, 32}) with([&](RenderOptions& o) { o.samples = n; });
}

TEST(Alpha, WhatKeepsNoTilesRefusesTranslucentScenesAlone) {
  for (const family::AxisInfo& r : family::rasterizer_axis()) {
    SCOPED_TRACE(r.name);
    RenderOptions o = options(Shader::flat);
    o.rasterizer = r.name;
    EXPECT_NO_THROW((void)frame_of(o, quad_scene()));
    o.opacity = 0.5F;
    if (r.name == "reference" || r.name == "grouped" || r.name == "tiled")
      EXPECT_NO_THROW((void)frame_of(o, quad_scene()));
    else
      refused(o);
    o.transparency.method = Transparency::none;
    EXPECT_NO_THROW((void)frame_of(o, quad_scene()));
  }
  RenderOptions search = options(Shader::flat, 0.5F);
  search.visibility = "search";
  refused(search);
}

TEST(Alpha, PassesThatLoadDoNotBlend) {
  const Scene scene = quad_scene();
  const SceneBinding binding(scene);
  Image<std::uint64_t> keys(kSize, kSize);
  const Targets targets{.keys = keys.view()};
  Painter renderer(options(Shader::flat, 0.5F));
  EXPECT_NO_THROW(renderer.render(binding.view(), pixel_camera(kSize, kSize), targets));
  EXPECT_THROW(renderer.render(binding.view(), pixel_camera(kSize, kSize), targets,
                               {.load = true, .first_id = 2}),
               Error);
}

/// Every instruction set has the bits of the plain loop, for any colours.
TEST(StoreBlended, IsTheScalarOne) {
  Random random(3);
  constexpr float kOdd[] = {0,   -0.0F, 1,     0.5F, 1e-30F,   1e-45F,    NAN,        -1,
                            2.5, 0.1F,  1e30F, 0.9F, INFINITY, -INFINITY, 0.0031308F, 0.99999994F};
  for (int n = 0; n < 2000; ++n) {
    raster::BlockColors colors;
    const bool odd = n % 2 == 0;
    for (float* const channel : {colors.r, colors.g, colors.b, colors.a})
      for (int i = 0; i < 64; ++i)
        channel[i] =
            odd ? kOdd[random.bits() % std::size(kOdd)] : static_cast<float>(random.real(0, 1));
    raster::Backdrop backdrop{.linear = n % 4 < 2};
    if (n % 8 < 4) backdrop.color = {static_cast<float>(random.real(0, 0.5)), 0.25F, 0.125F, 0.5F};
    backdrop.empty = {1, 2, 3, 4};
    const std::uint64_t covered = n % 3 == 0 ? ~std::uint64_t{0} : random.bits();
    Rgba8 expected[8 * 9];
    std::fill_n(expected, 72, Rgba8{9, 9, 9, 9});
    raster::kernels(Isa::scalar).store_blended(colors, covered, backdrop, expected, 9);
    for (const Isa isa : available_isas()) {
      Rgba8 out[8 * 9];
      std::fill_n(out, 72, Rgba8{9, 9, 9, 9});
      raster::kernels(isa).store_blended(colors, covered, backdrop, out, 9);
      for (int i = 0; i < 72; ++i)
        ASSERT_EQ(out[i], expected[i]) << name(isa) << " case " << n << " pixel " << i;
    }
  }
}

}  // namespace
}  // namespace rastrum::test::alpha_test
