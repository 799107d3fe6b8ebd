// SPDX-License-Identifier: BSD-3-Clause
// Fragments shaded by runs of their triangles (shade_runs) have the bits of blocks of pixels: every
// instruction set against the scalar path, which has no runs.
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/light.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/layer_picture.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test::runs_test {
namespace {

constexpr int kWidth = 96, kHeight = 80;

/// One triangle; a thin one needs float64 weights.
Mesh triangle(Random& random, bool thin) {
  Mesh m;
  const auto at = [&] { return static_cast<float>(random.real(-1, 1)); };
  const Vec3 a{at(), at(), at()}, b{at(), at(), at()};
  m.positions = {a, b, thin ? b + Vec3{0.004F, 0.003F, 0} : Vec3{at(), at(), at()}};
  m.indices = {0, 1, 2};
  m.normals.values = {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
  return m;
}

/// About fifty small meshes, several of which share a vector of triangles: with normals by vertex,
/// by index and by face, some with colours; large and small on the screen, crossing each other.
Scene small_meshes(std::uint64_t seed, bool colored) {
  Random random(seed);
  Scene scene;
  for (int i = 0; i < 50; ++i) {
    Mesh m = i % 5 > 2 ? triangle(random, i % 5 == 4)
                       : shapes::sphere(random.integer(2, 6), random.integer(3, 9));
    if (i % 5 == 1) m.normals = crease_normals(m.positions, m.indices, 40);
    if (i % 5 == 2) m.normals = {};
    if (colored && i % 3 == 0)
      for (std::size_t v = 0; v < m.positions.size(); ++v)
        m.colors.values.push_back({static_cast<float>(random.real(0, 1)),
                                   static_cast<float>(random.real(0, 1)), 0.5F, 1});
    Instance instance;
    instance.mesh = static_cast<std::uint32_t>(i);
    auto& at = instance.object_to_world.m;
    const double size = i % 7 == 0 ? 1.5 : random.real(0.1, 0.5);
    for (int k = 0; k < 3; ++k) {
      at[k][k] = size * random.real(0.5, 1);
      at[k][(k + 1) % 3] = i % 2 == 0 ? 0.0 : size * random.real(-0.5, 0.5);
      at[k][3] = random.real(-1, 1);
    }
    scene.meshes.push_back(std::move(m));
    scene.instances.push_back(std::move(instance));
  }
  return scene;
}

struct Look {
  const char* name;
  Shader shader;
  bool colored, lights;
  float threshold;
};
void PrintTo(const Look& look, std::ostream* out) {
  *out << look.name;
}

class Runs : public testing::TestWithParam<Look> {};

TEST_P(Runs, HaveTheBitsOfBlocks) {
  const Look look = GetParam();
  RenderOptions o({.width = kWidth,
                   .height = kHeight,
                   .shader = look.shader,
                   .background = {0.2F, 0.3F, 0.4F, 1},
                   .opacity = 0.4F},
                  {.threads = 1});
  o.transparency.alpha_threshold = look.threshold;
  if (look.lights) o.lights = {headlight(), Light{.kind = PointLight{.position = {1, 2, 1}}}};
  o.isa = Isa::scalar;
  Painter blocks(o);
  Camera camera;
  camera.eye = {0.3, 0.4, 2.2};  // inside some of them
  camera.target = {0, 0, 0};
  camera.near_plane = 0.05F;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Scene scene = small_meshes(seed, look.colored);
    const SceneBinding binding(scene);
    const LayerPicture expected = take(blocks, binding.view(), camera);
    ASSERT_GT(expected.counter("translucent fragments"), std::uint64_t{kWidth * kHeight});
    for (const Isa isa : available_isas()) {
      o.isa = isa;
      Painter runs(o);
      EXPECT_TRUE(same_bits(take(runs, binding.view(), camera), expected)) << name(isa);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Looks, Runs,
                         testing::Values(Look{"flat", Shader::flat, false, false, 1},
                                         Look{"flat_colored", Shader::flat, true, false, 1},
                                         Look{"normal", Shader::normal, false, false, 1},
                                         Look{"lambert", Shader::lambert, true, false, 1},
                                         Look{"phong", Shader::phong, false, false, 1},
                                         Look{"phong_colored", Shader::phong, true, false, 1},
                                         Look{"phong_lights", Shader::phong, true, true, 1},
                                         Look{"phong_threshold", Shader::phong, true, false, 0.8F}),
                         [](const auto& look) { return std::string(look.param.name); });

}  // namespace
}  // namespace rastrum::test::runs_test
