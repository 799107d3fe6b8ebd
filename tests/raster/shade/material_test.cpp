// SPDX-License-Identifier: BSD-3-Clause
// Materials: textures, filtering, alpha masks and the lighting formula, each against a second
// version of its definition.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/raster/shade/texture_lookup.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::material_test {
namespace {

constexpr int kSize = 64;

int to_code(double linear) {
  return static_cast<int>(std::lround(display(linear) * 255));
}

Mesh quad(Vec2 low = {0, 0}, Vec2 high = {1, 1}, double depth = 0.5) {
  return test::quad(kSize, low, high, depth);
}
/// A quad of one material.
Scene surface(const Material& material = {}, Vec2 low = {0, 0}, Vec2 high = {1, 1}) {
  Scene scene = single(quad(low, high));
  scene.materials.push_back(material);
  return scene;
}
Texture one_texel(Rgba8 texel) {
  return texture(1, 1, [&](int, int) { return texel; });
}

RenderOptions options(Shader shader = Shader::material, int width = kSize, int height = kSize) {
  return RenderOptions({.width = width, .height = height, .shader = shader}, {.threads = 2});
}
Frame draw_by_all(const RenderOptions& base, const Scene& scene, const Camera& camera,
                  std::initializer_list<RendererOptions> hows = {
                      {.threads = 1}, {.threads = 2}, {.threads = 8}}) {
  return EveryWay(base, hows).same([&](const RenderOptions& o) { return draw(o, scene, camera); });
}

Frame draw_quad(const Scene& scene, Shader shader = Shader::material) {
  return draw(options(shader), scene, pixel_camera(kSize, kSize));
}

/// The colours of a texture on a quad.
Image<Rgba8> draw_texture(Texture t, Vec2 low = {0, 0}, Vec2 high = {1, 1}) {
  return draw_quad(unlit(quad(low, high), std::move(t))).color8;
}

TEST(Srgb, TheCurveIsTheStandards) {
  double worst = 0;
  for (int i = 0; i <= 100000; ++i) {
    const float x = static_cast<float>(i) / 100000;
    worst = std::max(worst, std::abs(raster::srgb_from_linear(x) - display(x)));
  }
  EXPECT_LT(worst, 3.3e-5);
  EXPECT_EQ(raster::srgb_from_linear(NAN), 0);
  EXPECT_EQ(raster::srgb_from_linear(-1), 0);
  EXPECT_GE(raster::srgb_from_linear(INFINITY), 0.9999F);
}

TEST(Srgb, CodesAreTheNearest) {
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(raster::srgb_codes()(raster::decode_tables().srgb[static_cast<std::size_t>(code)]),
              code);
  for (int i = 0; i <= 200000; ++i) {
    const float x = static_cast<float>(i) / 200000;
    const double exact = display(x) * 255;
    ASSERT_LE(std::abs(raster::srgb_codes()(x) - exact), 0.5 + 1e-4) << x;
  }
  EXPECT_EQ(raster::srgb_codes()(NAN), 0);
  EXPECT_EQ(raster::srgb_codes()(-3), 0);
  EXPECT_EQ(raster::srgb_codes()(3), 255);
}

TEST(Material, CodesOfDataAreExact) {
  // SIMD lanes decode them without the table.
  for (std::size_t i = 0; i < 256; ++i) {
    const auto code = static_cast<float>(i);
    EXPECT_EQ(code * raster::kOf256 + code * raster::kOf65280, raster::decode_tables().unorm[i])
        << i;
  }
}

TEST(Material, TheFirstTexelIsTopLeft) {
  const Rgba8 red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255},
      dim{9, 90, 200, 255};
  const Rgba8 colors[2][2] = {{red, green}, {blue, dim}};
  Texture t = texture(2, 2, [&](int x, int y) { return colors[y][x]; });
  t.mag = TextureFilter::nearest;
  EXPECT_TRUE(pixels_are(draw_texture(std::move(t)),
                         [&](int x, int y) { return colors[y >= kSize / 2][x >= kSize / 2]; }));
}

TEST(Material, AnUnlitTexelKeepsItsCode) {
  Texture t = texture(256, 1, [](int x, int) {
    return Rgba8{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(255 - x),
                 static_cast<std::uint8_t>(x / 2), 255};
  });
  t.mag = t.min = TextureFilter::nearest;
  for (int part = 0; part < 4; ++part) {
    const float u = static_cast<float>(part) / 4;
    const Image<Rgba8> picture = draw_texture(t, {u, 0}, {u + 0.25F, 1});
    for (int x = 0; x < kSize; ++x)
      ASSERT_EQ(picture(x, 9), t.image(part * kSize + x, 0)) << part << ", " << x;
  }
}

TEST(Material, FilteringIsLinearInLightBetweenTexelCentres) {
  Texture t = texture(2, 2, [](int x, int y) { return grey(x == 0 ? 20 : (y == 0 ? 230 : 120)); });
  t.wrap_u = t.wrap_v = Wrap::clamp_to_edge;
  const Image<Rgba8> picture = draw_texture(std::move(t));
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double fx = std::clamp((x + 0.5) / kSize * 2 - 0.5, 0.0, 1.0);
      const double fy = std::clamp((y + 0.5) / kSize * 2 - 0.5, 0.0, 1.0);
      const double right = light(230) * (1 - fy) + light(120) * fy;
      const double exact = display(light(20) * (1 - fx) + right * fx) * 255;
      ASSERT_NEAR(picture(x, y).r, exact, 0.51) << x << ", " << y;
    }
}

int wrapped(Wrap wrap, int i, int size) {
  const int period = wrap == Wrap::mirrored_repeat ? 2 * size : size;
  const int m = ((i % period) + period) % period;
  switch (wrap) {
    case Wrap::clamp_to_edge:
      return std::clamp(i, 0, size - 1);
    case Wrap::mirrored_repeat:
      return m < size ? m : period - 1 - m;
    default:
      return m;
  }
}

TEST(Material, WrapModesOfBothAxes) {
  const auto color_of = [](int x, int y) {
    return Rgba8{static_cast<std::uint8_t>(40 * x), static_cast<std::uint8_t>(100 * y), 77, 255};
  };
  constexpr Wrap kModes[] = {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge};
  for (const Wrap u : kModes)
    for (const Wrap v : kModes) {
      Texture t = texture(4, 2, color_of);
      t.mag = TextureFilter::nearest;
      t.wrap_u = u;
      t.wrap_v = v;
      // 16 texels of 4 px across and 8 of 8 px down.
      const Image<Rgba8> picture = draw_texture(std::move(t), {-1.5F, -2}, {2.5F, 2});
      ASSERT_TRUE(pixels_are(picture,
                             [&](int x, int y) {
                               return color_of(wrapped(u, x / 4 - 6, 4), wrapped(v, y / 8 - 4, 2));
                             }))
          << static_cast<int>(u) << static_cast<int>(v);
    }
}

TEST(Material, RepeatingFiltersAcrossTheSeam) {
  const auto column = [](Wrap wrap) {
    Texture t = texture(2, 1, [](int x, int) { return grey(x == 0 ? 0 : 255); });
    t.wrap_u = wrap;
    return draw_texture(std::move(t))(0, 5).r;
  };
  const double u = 0.5 / kSize;
  EXPECT_NEAR(column(Wrap::repeat), display(0.5 - 2 * u) * 255, 0.51);
  EXPECT_EQ(column(Wrap::mirrored_repeat), 0);
  EXPECT_EQ(column(Wrap::clamp_to_edge), 0);
}

TEST(Material, NonsenseCoordinatesAreDrawn) {
  Mesh mesh = quad();
  mesh.texcoords.values[0] = {NAN, INFINITY};
  mesh.texcoords.values[1] = {-3e38F, 3e38F};
  const Frame frame = draw_quad(unlit(mesh, texture(4, 4, [](int, int) { return grey(50); })));
  for (const Rgba8 p : frame.color8.pixels()) ASSERT_EQ(p, grey(50));
}

Texture checkerboard(int size) {
  return texture(size, size, [](int x, int y) { return grey((x + y) % 2 == 0 ? 0 : 255); });
}

TEST(Material, AMinifiedCheckerboardIsItsMeanInLinearLight) {
  for (const int size : {2 * kSize, 4 * kSize, 16 * kSize}) {
    const Image<Rgba8> picture = draw_texture(checkerboard(size));
    for (const Rgba8 p : picture.pixels()) ASSERT_EQ(p, grey(188)) << size;
  }
  // One texel a pixel is not minified, so the mip levels do not average it.
  const Image<Rgba8> same = draw_texture(checkerboard(kSize));
  for (int x = 0; x < kSize; ++x) ASSERT_EQ(same(x, 3), grey(x % 2 == 1 ? 0 : 255));
  Texture plain = checkerboard(4 * kSize);
  plain.mipmaps = false;
  plain.min = TextureFilter::nearest;
  EXPECT_NE(draw_texture(std::move(plain))(3, 3), grey(188));
}

TEST(Material, TheLongerAxisOfTheFootprintChoosesTheLevel) {
  const auto stripes = [](int x, int) { return grey(x % 2 == 0 ? 0 : 255); };
  const auto middle = [&](Vec2 high) {
    return draw_texture(texture(kSize, kSize, stripes), {0, 0}, high)(20, 20);
  };
  EXPECT_EQ(middle({1, 1}), grey(0));
  EXPECT_EQ(middle({1, 2}), grey(188));    // one texel a pixel across, two down
  EXPECT_EQ(middle({1, 0.25F}), grey(0));  // one across, a quarter down
}

TEST(Material, TrilinearBlendsLevelsByTheLog) {
  // A step between black and white becomes a ramp of one texel's width on each level.
  Texture t = texture(128, 128, [](int x, int) { return grey(x < 64 ? 0 : 255); });
  t.wrap_u = t.wrap_v = Wrap::clamp_to_edge;
  const float span = std::sqrt(2.0F) / 2;  // 128 · span texels over 64 px: √2 a pixel, level 1/2
  const Image<Rgba8> picture =
      draw_texture(std::move(t), {0.5F - span / 2, 0}, {0.5F + span / 2, span});
  for (int x = 0; x < kSize; ++x) {
    const double u = 0.5 - span / 2 + (x + 0.5) / kSize * span;
    const double finer = std::clamp(u * 128 - 63.5, 0.0, 1.0);
    const double coarser = std::clamp(u * 64 - 31.5, 0.0, 1.0);
    ASSERT_NEAR(picture(x, 30).r, display((finer + coarser) / 2) * 255, 0.6) << x;
  }
}

TEST(TextureSet, TheLastLevelIsTheMeanForOddSizesToo) {
  Numbers numbers;
  for (const auto& [width, height] : {std::pair{64, 64}, {45, 27}, {1, 7}, {5, 1}, {3, 128}}) {
    std::vector<Texture> textures;
    textures.push_back(texture(width, height, [&](int, int) {
      return Rgba8{static_cast<std::uint8_t>(numbers(256)), static_cast<std::uint8_t>(numbers(256)),
                   static_cast<std::uint8_t>(numbers(64)), static_cast<std::uint8_t>(numbers(256))};
    }));
    double r = 0, a = 0, plain = 0;
    const auto pixels = textures[0].image.pixels();
    for (const Rgba8 p : pixels) {
      r += light(p.r) / static_cast<double>(pixels.size());
      plain += p.r / static_cast<double>(pixels.size());
      a += p.a / static_cast<double>(pixels.size());
    }
    MemoryAccount memory;
    raster::TextureSet set(memory);
    const std::vector<std::uint8_t> both{3};
    set.update(textures, both, nullptr);
    const auto last = [&](raster::TexelUse use) {
      const raster::MipChain& chain = *set.find(0, use);
      const raster::MipLevel& level = chain.level[chain.levels - 1];
      EXPECT_EQ(level.width, 1);
      EXPECT_EQ(level.height, 1);
      return level.texels[0];
    };
    // Each level rounds to 8 bits.
    EXPECT_NEAR(last(raster::TexelUse::color).r, to_code(r), 2) << width << "x" << height;
    EXPECT_NEAR(last(raster::TexelUse::data).r, plain, 2) << width << "x" << height;
    EXPECT_NEAR(last(raster::TexelUse::color).a, a, 2) << width << "x" << height;
  }
}

TEST(TextureSet, ChainsAreKeptUntilTheirTextureChanges) {
  MemoryAccount memory;
  raster::TextureSet set(memory);
  std::vector<Texture> textures{checkerboard(32), checkerboard(16)};
  const std::vector<std::uint8_t> uses{1, 3};
  set.update(textures, uses, nullptr);
  EXPECT_EQ(set.builds(), 3U);
  EXPECT_GE(memory.peak(), (16 * 16 + 2 * 8 * 8) * sizeof(Rgba8));
  set.update(textures, uses, nullptr);
  EXPECT_EQ(set.builds(), 3U);
  for (Rgba8& p : textures[0].image.pixels()) p = grey(3);  // same address and size
  set.update(textures, uses, nullptr);
  EXPECT_EQ(set.builds(), 4U);
  EXPECT_EQ(set.find(0, raster::TexelUse::color)->level[3].texels[0], grey(3));
  EXPECT_EQ(set.find(0, raster::TexelUse::data), nullptr);
  textures[1].image = Image<Rgba8>(4, 4);
  set.update(textures, uses, nullptr);
  EXPECT_EQ(set.builds(), 6U);
  EXPECT_EQ(set.find(1, raster::TexelUse::data)->levels, 3);
  set.update({}, {}, nullptr);
  EXPECT_EQ(set.find(0, raster::TexelUse::color), nullptr);
}

/// A masked quad in front of a plain one; the mask has holes at `is_hole`.
Scene masked(const auto& is_hole) {
  Texture t = texture(kSize, kSize, [&](int x, int y) {
    return Rgba8{200, 10, 10, static_cast<std::uint8_t>(is_hole(x, y) ? 127 : 128)};
  });
  t.min = t.mag = TextureFilter::nearest;
  Scene scene = unlit(quad(), std::move(t));
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials.emplace_back();
  scene.meshes.push_back(quad({0, 0}, {1, 1}, 0.25));
  scene.meshes[1].material = 1;
  scene.instances.push_back({1, Mat4d::identity()});
  return scene;
}

TEST(AlphaMask, HolesShowWhatLiesBehindWithEveryShader) {
  std::vector<bool> holes;
  Numbers numbers;
  for (int i = 0; i < kSize * kSize; ++i) holes.push_back(numbers(3) == 0);
  const auto is_hole = [&](int x, int y) { return holes[static_cast<std::size_t>(y * kSize + x)]; };
  Scene scene = masked(is_hole);
  for (const Shader shader : {Shader::material, Shader::phong, Shader::id})
    for (const Device device : {Device::serial, Device::threads}) {
      RenderOptions o = options(shader);
      o.device = device;
      const Frame frame = draw(o, scene, pixel_camera(kSize, kSize));
      ASSERT_TRUE(pixels_are(frame.ids, is_hole,
                             [](std::int64_t id, bool hole) { return (id >= 2) == hole; }));
      EXPECT_EQ(frame.stats.fragments, 2U * kSize * kSize);
    }
  scene.instances.pop_back();
  const Frame frame = draw_quad(scene);
  EXPECT_EQ(frame.stats.pixels_covered,
            static_cast<std::uint64_t>(std::count(holes.begin(), holes.end(), false)));
  scene.materials[0].alpha_mode = AlphaMode::opaque;
  EXPECT_EQ(draw_quad(scene).stats.pixels_covered, 1U * kSize * kSize);
  scene.materials[0].alpha_mode = AlphaMode::blend;  // drawn as opaque
  EXPECT_EQ(draw_quad(scene).stats.pixels_covered, 1U * kSize * kSize);
}

TEST(AlphaMask, FacesOfOneMeshHaveTheirOwn) {
  Scene scene = masked([](int, int) { return true; });
  scene.instances.pop_back();
  scene.meshes[0].face_materials = {1, 0};
  const Frame frame = draw_quad(scene);
  scene.meshes[0].face_materials = {1, 1};
  const Frame whole = draw_quad(scene);
  for (std::size_t i = 0; i < whole.ids.pixels().size(); ++i)
    ASSERT_EQ(frame.ids.pixels()[i], whole.ids.pixels()[i] == 0 ? 0 : -1) << i;
}

struct V3 {
  double x, y, z;
};
double dot(V3 a, V3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
V3 unit(V3 a) {
  const double l = std::sqrt(dot(a, a));
  return {a.x / l, a.y / l, a.z / l};
}

/// The header's formula in float64, seen along −z.
double lit(double base, double metallic, double roughness, double occlusion, double emissive,
           V3 n) {
  const V3 v{0, 0, 1};
  const double f0 = 0.04 + (base - 0.04) * metallic, diffuse = base * (1 - metallic);
  const double alpha = roughness * roughness, a2 = alpha * alpha;
  const double nv = std::max(dot(n, v), 1e-4);
  double sum = emissive;
  const auto add = [&](V3 direction, double radiance) {
    const V3 l = unit(direction), h = unit({l.x + v.x, l.y + v.y, l.z + v.z});
    const double nl = std::max(dot(n, l), 0.0), nh = std::max(dot(n, h), 0.0);
    const double d = a2 / std::pow(nh * nh * (a2 - 1) + 1, 2);
    const double g = 0.5 / (2 * nl * nv * (1 - alpha) + (nl + nv) * alpha);
    const double f = f0 + (1 - f0) * std::pow(1 - dot(v, h), 5);
    sum += radiance * nl * (diffuse * (1 - f) + f * d * g);
  };
  add({0.4, 0.6, 1}, 0.65);
  add({-0.8, 0.1, 0.6}, 0.2);
  const auto sky = [](double y) { return 0.21 + 0.09 * y; };
  const double f = f0 + (std::max(1 - roughness, f0) - f0) * std::pow(1 - nv, 5);
  return sum + occlusion * (diffuse * sky(n.y) + f * sky(2 * nv * n.y - v.y));
}

TEST(Material, LightingIsTheFormulaOfTheHeader) {
  const V3 normals[] = {
      {0, 0, 1}, unit({0.3, 0.5, 1}), unit({-1, -0.4, 0.6}), unit({0.1, -2, 0.5})};
  for (const V3 n : normals)
    for (const float metallic : {0.0F, 0.4F, 1.0F})
      for (const float roughness : {0.15F, 0.5F, 1.0F}) {
        Scene scene = surface({.base_color = {0.8F, 0.3F, 0.05F, 1},
                               .metallic = metallic,
                               .roughness = roughness,
                               .occlusion_texture = 0,
                               .occlusion_strength = 0.5F,
                               .emissive = {0, 0.02F, 0.1F}});
        scene.meshes[0].normals.values.assign(
            4, {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
        scene.textures.push_back(one_texel({51, 0, 0, 255}));
        const Frame frame = draw_quad(scene);
        const double occlusion = 1 + 0.5 * (0.2 - 1);
        const Rgba8 p = frame.color8(31, 17);
        const auto exact = [&](double base, double emissive) {
          return 255 * display(lit(base, metallic, roughness, occlusion, emissive, n));
        };
        EXPECT_NEAR(p.r, exact(0.8F, 0), 0.52) << metallic << " " << roughness << " " << n.x;
        EXPECT_NEAR(p.g, exact(0.3F, 0.02F), 0.52) << metallic << " " << roughness << " " << n.x;
        EXPECT_NEAR(p.b, exact(0.05F, 0.1F), 0.52) << metallic << " " << roughness << " " << n.x;
        EXPECT_EQ(p.a, 255);
      }
}

TEST(Material, MetallicAndRoughnessComeFromBlueAndGreen) {
  Scene scene = surface({.base_color = {0.8F, 0.8F, 0.8F, 1},
                         .metallic = 0.5F,
                         .roughness = 0.9F,
                         .metallic_roughness_texture = 0});
  scene.textures.push_back(one_texel({255, 102, 204, 0}));
  const double exact = 255 * display(lit(0.8F, 0.4, 0.36, 1, 0, {0, 0, 1}));
  EXPECT_NEAR(draw_quad(scene).color8(3, 3).r, exact, 0.52);
}

/// The colour of a quad whose normal map is `texel`, or whose vertices have `normal`.
Rgba8 bumped(Rgba8 texel, Vec2 low, Vec2 high) {
  Scene scene = surface({.normal_texture = 0}, low, high);
  scene.textures.push_back(one_texel(texel));
  return draw_quad(scene).color8(40, 40);
}
Rgba8 tilted(Vec3 normal) {
  Scene scene = surface();
  scene.meshes[0].normals.values.assign(4, normal);
  return draw_quad(scene).color8(40, 40);
}
void expect_near(Rgba8 a, Rgba8 b) {
  EXPECT_NEAR(a.r, b.r, 1);
  EXPECT_NEAR(a.g, b.g, 1);
  EXPECT_NEAR(a.b, b.b, 1);
}

TEST(Material, NormalMapsGoRightAndUpInTheirPicture) {
  // 204 means 0.6, 230 means 0.804, 127.5 means 0.
  const Rgba8 right{204, 128, 230, 255}, up{128, 204, 230, 255};
  expect_near(bumped(right, {0, 0}, {1, 1}), tilted({0.6F, 0.004F, 0.804F}));
  expect_near(bumped(up, {0, 0}, {1, 1}), tilted({0.004F, 0.6F, 0.804F}));
  // Mirrored texture coordinates mirror the bumps too.
  expect_near(bumped(right, {1, 0}, {0, 1}), tilted({-0.6F, 0.004F, 0.804F}));
  expect_near(bumped(up, {1, 0}, {0, 1}), tilted({-0.004F, 0.6F, 0.804F}));
  expect_near(bumped(up, {0, 1}, {1, 0}), tilted({0.004F, -0.6F, 0.804F}));
  EXPECT_NE(tilted({0.6F, 0, 0.8F}), tilted({-0.6F, 0, 0.8F}));
}

TEST(Material, BackFacesAreLitFromTheirSide) {
  Scene scene = surface();
  const Rgba8 front = draw_quad(scene).color8(9, 9);
  scene.meshes[0].indices = {0, 2, 3, 0, 1, 2};
  EXPECT_EQ(draw_quad(scene).color8(9, 9).a, 0) << "single-sided";
  scene.materials[0].double_sided = true;
  EXPECT_EQ(draw_quad(scene).color8(9, 9), front);
  scene.meshes[0].normals.values.assign(4, {0, 0, -1});
  EXPECT_EQ(draw_quad(scene).color8(9, 9), front);
}

TEST(Material, MirroringTurnsTheSideThatIsSeen) {
  Scene scene = surface();
  const Rgba8 front = draw_quad(scene).color8(9, 9);
  scene.instances[0].object_to_world.m[0][0] = -1;
  EXPECT_EQ(draw_quad(scene).color8(9, 9), front);
}

TEST(Material, WithoutMaterialsTheDefaultOneIsUsed) {
  Scene scene = single(quad());
  const double plain = std::pow((0.8 + 0.055) / 1.055, 2.4);  // red of the plain colour, as light
  const double exact = 255 * display(lit(plain, 0, 1, 1, 0, {0, 0, 1}));
  EXPECT_NEAR(draw_quad(scene).color8(9, 9).r, exact, 0.52);
  scene.meshes[0].material = 7;
  EXPECT_THROW((void)draw_quad(scene), Error);
}

TEST(Material, IndicesOutOfRangeAreNamed) {
  const Scene good = unlit(quad(), checkerboard(4));
  (void)draw_quad(good, Shader::phong);
  const auto refused = [&](const char* part, const auto& change) {
    Scene scene = good;
    change(scene, scene.meshes[0]);
    expect_refused(part, [&] { (void)draw_quad(scene, Shader::phong); });
  };
  refused("texture 1", [](Scene& s, Mesh&) { s.materials[0].normal_texture = 1; });
  refused("material 1", [](Scene&, Mesh& m) { m.material = 1; });
  refused("material 3", [](Scene&, Mesh& m) { m.face_materials = {0, 3}; });
  refused("face materials are fewer", [](Scene&, Mesh& m) { m.face_materials = {0}; });
}

TEST(Material, TheSameBitsEverywhere) {
  const Scene scene = everything();
  Camera camera{.eye = {0.2F, 0.1F, 1.1F}, .near_plane = 0.3F};
  for (const Shader shader : {Shader::material, Shader::phong}) {
    const Frame first = draw_by_all(options(shader, 203, 141), scene, camera);
    ASSERT_GT(first.stats.triangles.clipped, 0U);
  }
}

// Triangles of a pixel or two, which a bin sets up once for all blocks: with and without normals,
// colours and textures, of one material or many, clipped, and in instances.
TEST(Material, SmallTrianglesAreTheSameBits) {
  Scene scene = everything();
  for (Material& m : scene.materials) m.normal_texture = kNoTexture;  // those go by blocks
  Mesh rich = shapes::sphere(120, 160);
  rich.texcoords = {};
  rich.colors = {};
  for (const Vec3& p : rich.positions) {
    rich.texcoords.values.push_back({3 * p.x, 3 * p.y + p.z});
    rich.colors.values.push_back({0.5F + p.x / 2, 1, 0.5F + p.z / 2, 1});
  }
  for (std::uint32_t i = 0; i < rich.triangle_count(); ++i)
    rich.face_materials.push_back(i / 5 % 4);
  Mesh poor = shapes::sphere(100, 140);
  poor.normals = {};
  poor.texcoords = {};
  poor.material = 1;
  scene.meshes = {rich, poor};
  const auto at = [](double x, double y, double z, double size) {
    Mat4d m = Mat4d::identity();
    m.m[0][0] = m.m[1][1] = m.m[2][2] = size;
    m.m[0][3] = x;
    m.m[1][3] = y;
    m.m[2][3] = z;
    return m;
  };
  scene.instances = {{0, at(-0.4, 0.2, 0, 0.6)}, {1, at(0.5, 0.1, 0.1, 0.5)}};
  for (int i = 0; i < 8; ++i) scene.instances.push_back({0, at(0.25 * i - 1, -0.6, 0.4, 0.15)});
  scene.instances.push_back({1, at(0.3, 0.6, 1.2, 0.3)});  // the near plane cuts it
  Scene plain = scene;
  plain.materials.clear();
  plain.textures.clear();
  for (Mesh& mesh : plain.meshes) {
    mesh.face_materials.clear();
    mesh.material = 0;
  }
  Camera camera{.eye = {0.1F, 0.1F, 1.8F}, .near_plane = 0.6F};
  for (const Scene& drawn : {scene, plain}) {
    const Frame first = draw_by_all(options(Shader::material, 331, 277), drawn, camera);
    ASSERT_GT(first.stats.triangles.clipped, 0U);
    ASSERT_GT(first.stats.pixels_covered, 20000U);
  }
}

TEST(Material, ATriangleIsShadedAloneAsAmongOthers) {
  // A picture of each triangle alone agrees with the whole one where it is visible: neither
  // neighbouring lanes nor the order of work affect a fragment.
  Scene whole = everything();
  whole.meshes[0].indices.resize(3 * 40);
  whole.meshes[0].face_materials.resize(40);
  Camera camera{.eye = {0.2F, 0.1F, 1.4F}, .near_plane = 0.05F};
  const Frame all = draw(options(), whole, camera);
  std::uint64_t compared = 0;
  for (std::size_t t = 0; t < 40; ++t) {
    Scene one = whole;
    Mesh& mesh = one.meshes[0];
    mesh.indices = {whole.meshes[0].indices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                    whole.meshes[0].indices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3)};
    mesh.face_materials = {whole.meshes[0].face_materials[t]};
    const Frame alone = draw(options(), one, camera);
    for (std::size_t i = 0; i < all.ids.pixels().size(); ++i) {
      if (all.ids.pixels()[i] != static_cast<std::int64_t>(t)) continue;
      ++compared;
      ASSERT_EQ(all.color8.pixels()[i], alone.color8.pixels()[i]) << "triangle " << t;
    }
  }
  EXPECT_GT(compared, 800U);
}

TEST(Material, RealFilesAreTheSameOnEveryDevice) {
  int drawn = 0;
  for (const char* name : {"gltf/BoxTextured.glb", "gltf/TextureSettingsTest.glb",
                           "alpha/AlphaBlendModeTest.glb", "small/spot/spot_triangulated.obj"}) {
    const std::filesystem::path file = shared_data(name);
    if (!std::filesystem::exists(file)) continue;
    ++drawn;
    const Scene scene = io::read_scene(file);
    const Camera camera = fit_camera(SceneBinding(scene).view(), 1.0F, false);
    SCOPED_TRACE(name);
    const Frame first = draw_by_all(options(Shader::material, 160, 120), scene, camera, {{}});
    EXPECT_GT(first.stats.pixels_covered, 1000U);
  }
  if (drawn == 0) GTEST_SKIP() << "there is no ../shared/data";
}

}  // namespace
}  // namespace rastrum::test::material_test
