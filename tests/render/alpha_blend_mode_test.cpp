// SPDX-License-Identifier: BSD-3-Clause
// Khronos' AlphaBlendModeTest: five plates whose alpha falls from 1 at the label "1.0" to 0 at
// ".00". They are seen straight on at 100 px a unit, and each is probed at the heights of its
// labels.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/materials.hpp"

namespace rastrum::test::alpha_blend_mode_test {
namespace {

constexpr int kWidth = 900, kHeight = 250;
constexpr double kPxPerUnit = 100;

/// A plate: its place, its triangles' position in the file, and its name there.
struct Plate {
  const char* label;
  double x;
  std::int64_t first_id;
};
constexpr Plate kOpaque{"Opaque", -3, 30}, kBlend{"Blend", -1.5, 32},
    kCutoff25{"Cutoff 0.25", 0, 34}, kDefault{"Cutoff Default", 1.5, 36},
    kCutoff75{"Cutoff 0.75", 3, 38};

/// The file begins with the triangles of the wall behind.
constexpr std::int64_t kWallEnd = 30;

struct Probe {
  int x, y;
};
/// Beside the middle of the plate, at the height where its label is `alpha`.
Probe at(const Plate& plate, double alpha, double aside = 0.1) {
  const double y = 1.865 - 1.565 * alpha;  // of the labels' centres in the file
  return {static_cast<int>(std::floor(kWidth / 2 + (plate.x + aside) * kPxPerUnit)),
          static_cast<int>(std::floor(kHeight / 2 + (1 - y) * kPxPerUnit))};
}

class AlphaBlendModeTest : public testing::TestWithParam<Shader> {
 protected:
  void SetUp() override {
    const std::filesystem::path file = shared_data("alpha/AlphaBlendModeTest.glb");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
    scene_ = io::read_scene(file);
    ASSERT_EQ(scene_.meshes[scene_.instances[2].mesh].name, "TestBlendMesh");
  }
  Material& material(const std::string& name) {
    for (Material& m : scene_.materials)
      if (m.name == name) return m;
    ADD_FAILURE() << "no material " << name;
    return scene_.materials[0];
  }
  [[nodiscard]] Frame picture() const {
    RenderOptions o({.width = kWidth, .height = kHeight, .shader = GetParam()});
    Camera camera{.eye = {0, 1, 5},
                  .target = {0, 1, 0},
                  .orthographic = true,
                  .orthographic_height = static_cast<float>(kHeight / kPxPerUnit),
                  .near_plane = 1,
                  .far_plane = 10};
    return draw(o, scene_, camera);
  }
  Scene scene_;
};

std::string where(const Plate& plate, double alpha) {
  return std::string(plate.label) + " at label " + std::to_string(alpha);
}

TEST_P(AlphaBlendModeTest, OpaqueIgnoresAlpha) {
  const Frame frame = picture();
  for (Texture& t : scene_.textures)
    for (Rgba8& p : t.image.pixels()) p.a = 255;
  const Frame without_alpha = picture();
  for (const double alpha : {0.02, 0.25, 0.5, 0.75, 0.98}) {
    const Probe p = at(kOpaque, alpha);
    EXPECT_EQ(frame.ids(p.x, p.y) & ~1, kOpaque.first_id) << where(kOpaque, alpha);
    EXPECT_EQ(frame.color8(p.x, p.y), without_alpha.color8(p.x, p.y)) << where(kOpaque, alpha);
    EXPECT_EQ(frame.color8(p.x, p.y).a, 255);
  }
}

TEST_P(AlphaBlendModeTest, MaskCutsAtItsCutoff) {
  const Frame frame = picture();
  for (const auto& [plate, cutoff] :
       {std::pair{kCutoff25, 0.25}, {kDefault, 0.5}, {kCutoff75, 0.75}})
    for (double alpha = 0.05; alpha < 0.98; alpha += 0.01) {
      if (std::abs(alpha - cutoff) < 0.015) continue;  // a pixel is 0.0064
      const Probe p = at(plate, alpha);
      const std::int64_t id = frame.ids(p.x, p.y);
      ASSERT_TRUE(alpha > cutoff ? (id & ~1) == plate.first_id : id >= 0 && id < kWallEnd)
          << where(plate, alpha) << ": triangle " << id;
      ASSERT_EQ(frame.color8(p.x, p.y).a, 255) << where(plate, alpha);
    }
}

TEST_P(AlphaBlendModeTest, BlendLetsTheWallThroughByItsAlpha) {
  const Frame frame = picture();
  Material& m = material("MatBlend");
  m.alpha_mode = AlphaMode::opaque;
  const Frame plate = picture();
  m.alpha_mode = AlphaMode::blend;
  m.base_color.w = 0;
  const Frame wall = picture();
  const bool linear = GetParam() == Shader::material;
  const auto mixed = [&](int front, int behind, double alpha) {
    if (!linear) return front * alpha + behind * (1 - alpha);
    return 255 * display(light(front) * alpha + light(behind) * (1 - alpha));
  };
  int contrasts = 0;
  for (const double alpha : {0.05, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9})
    for (const double aside : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
      const Probe p = at(kBlend, alpha, aside);
      const Rgba8 front = plate.color8(p.x, p.y), behind = wall.color8(p.x, p.y),
                  got = frame.color8(p.x, p.y);
      ASSERT_EQ(frame.ids(p.x, p.y) & ~1, kBlend.first_id) << where(kBlend, alpha);
      // Alpha has 8 bits, and half a pixel is 0.003 of it.
      ASSERT_NEAR(got.r, mixed(front.r, behind.r, alpha), 3) << where(kBlend, alpha);
      ASSERT_NEAR(got.g, mixed(front.g, behind.g, alpha), 3) << where(kBlend, alpha);
      ASSERT_NEAR(got.b, mixed(front.b, behind.b, alpha), 3) << where(kBlend, alpha);
      ASSERT_EQ(got.a, 255) << where(kBlend, alpha);
      contrasts += std::abs(front.b - behind.b) + std::abs(front.r - behind.r) > 60;
    }
  EXPECT_GT(contrasts, 20) << "the wall looks like the plate";
}

INSTANTIATE_TEST_SUITE_P(Shaders, AlphaBlendModeTest, testing::Values(Shader::material, Shader::id),
                         [](const auto& p) { return std::string(name(p.param)); });

}  // namespace
}  // namespace rastrum::test::alpha_blend_mode_test
