// SPDX-License-Identifier: BSD-3-Clause
// `material` against the same formula in OpenGL (llvmpipe): all features of a material, what the
// peer refuses, and `rastrum bench materials` itself.
#include <bench/bench.hpp>
#include <bench/peers/compare.hpp>
#include <bench/peers/gl_materials.hpp>
#include <bench/scenes.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/bench/gl_fixture.hpp"
#include "tests/io/files.hpp"

namespace rastrum::bench::gl_materials_test {
namespace {

constexpr int kWidth = 320, kHeight = 240;
// Steps of 255. Neighbouring texels differ as much as possible, so that differences in the level of
// detail show, which llvmpipe takes from differences within a quad of pixels.
constexpr int kTolerance = 3;

/// Waves with another phase in each channel, so that every wrong read shows.
Texture waves(int width, int height, double phase) {
  Texture t{.image = Image<Rgba8>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto channel = [&](double more) {
        const double s = std::sin(0.7 * x + phase + more) * std::cos(0.4 * y - more);
        return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * s));
      };
      t.image(x, y) = {channel(0), channel(1), channel(2), 255};
    }
  return t;
}

/// A quad through (x, y, z) that leans back and repeats its texture `repeats` times.
Mesh quad(Vec3 at, float lean, float repeats, std::uint32_t material) {
  Mesh mesh{.material = material};
  for (const Vec2 p : {Vec2{-1, -1}, Vec2{1, -1}, Vec2{1, 1}, Vec2{-1, 1}}) {
    mesh.positions.push_back(at + Vec3{p.x, p.y * (1 - lean), -4 * p.y * lean});
    mesh.normals.values.push_back({p.x * 0.3F, lean, 1});
    mesh.texcoords.values.push_back({(p.x + 1) / 2 * repeats, (1 - p.y) / 2 * repeats});
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// Quads beside and behind each other, each with more features than the one before.
Scene every_feature() {
  Scene s{.textures = {waves(37, 64, 0), waves(64, 16, 1), waves(32, 32, 2)}};
  s.textures[1].wrap_u = Wrap::mirrored_repeat;
  s.textures[2].wrap_v = Wrap::clamp_to_edge;
  s.textures[2].mag = TextureFilter::nearest;
  const auto add = [&](const Material& m, Vec3 at, float lean, float repeats) {
    s.materials.push_back(m);
    s.meshes.push_back(quad(at, lean, repeats, static_cast<std::uint32_t>(s.materials.size() - 1)));
    s.instances.push_back({.mesh = static_cast<std::uint32_t>(s.meshes.size() - 1)});
  };
  Material m{.base_color = {0.9F, 0.5F, 0.4F, 1},
             .metallic = 0.3F,
             .roughness = 0.4F,
             .double_sided = true};
  add(m, {-2, 1.1F, 0}, 0, 1);
  m.base_color_texture = 0;
  add(m, {0, 1.1F, 0}, 0.5F, 3);
  m.metallic_roughness_texture = 1;
  add(m, {2, 1.1F, 0}, 0.3F, 2);
  m.occlusion_texture = 2;
  m.occlusion_strength = 0.7F;
  m.emissive = {0.2F, 0.1F, 0.3F};
  m.emissive_texture = 1;
  add(m, {-2, -1.1F, 0}, 0.6F, 5);
  s.meshes.back().colors.values = {{1, 0.2F, 0.5F, 1}, {0.3F, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 1, 1}};
  m.alpha_mode = AlphaMode::mask;
  m.alpha_texture = 2;
  add(m, {0, -1.1F, 0.5F}, 0, 1);
  m = {};
  add(m, {0.5F, -1.1F, -1}, 0, 1);  // behind the holes, single-sided
  add(m, {2, -1.1F, 0}, 0, 1);
  s.instances.back().object_to_world.m[0][0] = -1;  // mirrored: its front faces the camera
  s.instances.back().object_to_world.m[0][3] = 4;
  add(m, {1, -1.1F, 1}, 0, 1);
  s.meshes.back().indices = {0, 2, 1, 0, 3, 2};  // its back is left out
  return s;
}

Camera camera() {
  return Camera{.eye = {0.4, 0.3, 5}, .target = {0, 0, 0}};
}

class GlMaterialsTest : public GlFixture<GlMaterials> {
 protected:
  Image<Rgba8> theirs(const Scene& scene) {
    const SceneBinding bound(scene);
    gl_->set_scene(bound.view());
    gl_->set_view(camera(), kWidth, kHeight);
    gl_->draw();
    return gl_->colors();
  }
  static Image<Rgba8> ours(const Scene& scene) {
    Image<Rgba8> image(kWidth, kHeight);
    const SceneBinding bound(scene);
    Renderer({.threads = 2})
        .render(bound.view(), camera(),
                {.width = kWidth, .height = kHeight, .shader = Shader::material},
                {.color8 = image});
    return image;
  }
};

TEST_F(GlMaterialsTest, DrawsAllThatAMaterialMayHave) {
  const Scene scene = every_feature();
  const Image<Rgba8> expected = ours(scene);
  const ColorDifference d = compare_colors(expected, theirs(scene), kTolerance);
  EXPECT_GT(d.covered, 30'000U);
  EXPECT_GE(d.share(), 0.999);
  EXPECT_EQ(d.one_only, 0U);

  // Each of them affects this picture.
  const auto change = [&](const char* what, auto&& f) {
    Scene other = every_feature();
    f(other);
    EXPECT_LT(compare_colors(expected, theirs(other), kTolerance).share(), 0.99) << what;
  };
  change("base colour", [](Scene& s) { s.materials[1].base_color_texture = kNoTexture; });
  change("metallic", [](Scene& s) { s.materials[2].metallic_roughness_texture = kNoTexture; });
  change("occlusion", [](Scene& s) { s.materials[3].occlusion_texture = kNoTexture; });
  change("emission", [](Scene& s) { s.materials[3].emissive_texture = kNoTexture; });
  change("colours", [](Scene& s) { s.meshes[3].colors = {}; });
  change("mask", [](Scene& s) { s.materials[4].alpha_mode = AlphaMode::opaque; });
  change("cutoff", [](Scene& s) { s.materials[4].alpha_cutoff = 0.7F; });
  change("wrapping", [](Scene& s) { s.textures[1].wrap_u = Wrap::repeat; });
  change("magnified", [](Scene& s) { s.textures[2].mag = TextureFilter::linear; });
  change("minified", [](Scene& s) { s.textures[1].mipmaps = false; });
  change("sides", [](Scene& s) { s.materials[7].double_sided = true; });
  change("mirrored", [](Scene& s) { s.meshes[6].indices = {0, 2, 1, 0, 3, 2}; });
}

TEST_F(GlMaterialsTest, RefusesWhatItDoesNotDraw) {
  const auto refuses = [&](const char* what, auto&& f) {
    Scene scene = every_feature();
    f(scene);
    const SceneBinding bound(scene);
    EXPECT_THROW(gl_->set_scene(bound.view()), Error) << what;
  };
  refuses("blending", [](Scene& s) { s.materials[0].alpha_mode = AlphaMode::blend; });
  refuses("opacity", [](Scene& s) { s.materials[0].opacity = 0.5F; });
  refuses("unlit", [](Scene& s) { s.materials[0].unlit = true; });
  refuses("normal maps", [](Scene& s) { s.materials[0].normal_texture = 0; });
  refuses("a colour", [](Scene& s) { s.instances[0].color = Vec4{1, 1, 1, 1}; });
  Camera flat{.orthographic = true};
  EXPECT_THROW(gl_->set_view(flat, kWidth, kHeight), Error);
}

class BenchMaterials : public testing::TestWithParam<const char*> {};

TEST_P(BenchMaterials, RunsQuickly) {
  const SceneInfo& scene = scene_by_name(GetParam());
  if (!available(scene)) GTEST_SKIP() << "no " << scene.file << " in the shared data";
  if (const Started<GlMaterials> started(2); !started.peer) GTEST_SKIP() << started.note;
  const test::TempFolder folder;
  const std::string json = folder.path("materials.json").string(),
                    pictures = folder.path("").string();
  const std::vector<std::string_view> args{"materials", "--quick",  "--rounds",   "1",
                                           "--scenes",  scene.name, "--sizes",    "320x180",
                                           "--json",    json,       "--pictures", pictures};
  ASSERT_EQ(run(args), 0);
  const nlohmann::json j = nlohmann::json::parse(test::slurp(json));
  ASSERT_FALSE(j["rows"].empty());
  for (const nlohmann::json& row : j["rows"]) {
    EXPECT_EQ(row["textures"] != 0, scene.name == "sponza");
    EXPECT_GT(row["difference"]["covered"], 5000);
    EXPECT_GT(row["ratio_llvmpipe"], 0);
  }
  for (const char* who : {"-320x180-rastrum.png", "-320x180-llvmpipe.png"})
    EXPECT_TRUE(std::filesystem::exists(folder.path(std::string(scene.name) + who)));
}

INSTANTIATE_TEST_SUITE_P(Scenes, BenchMaterials, testing::Values("shape-teapot", "sponza"),
                         [](const auto& param) {
                           return std::string(param.param == std::string_view("sponza") ? "sponza"
                                                                                        : "shape");
                         });

}  // namespace
}  // namespace rastrum::bench::gl_materials_test
