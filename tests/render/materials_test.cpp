// Materials over the family: textures, alpha masks (whose fragments are tested before the maximum)
// and several instances. Ids, depth and coverage are the same bits; colours of one instruction set
// too.

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test::materials_test {
namespace {

Texture noise(Random& r, int size) {
  Texture t{.image = Image<Rgba8>(size, size)};
  const auto byte = [&] { return static_cast<std::uint8_t>(r.integer(0, 255)); };
  for (Rgba8& p : t.image.pixels()) p = {byte(), byte(), byte(), byte()};
  return t;
}

// A sphere cut out by a mask around an opaque knot, before a wall of boxes.
Scene masked_scene(std::uint64_t seed) {
  Random r(seed);
  Scene scene;
  scene.meshes = {shapes::sphere(10, 20), shapes::torus_knot(2, 3, 60, 8), shapes::boxes(3)};
  for (int i = 0; i < 4; ++i) scene.textures.push_back(noise(r, 1 << r.integer(0, 5)));
  scene.materials.resize(3);
  Material& mask = scene.materials[0];
  mask.base_color_texture = 0;
  mask.alpha_mode = AlphaMode::mask;
  mask.alpha_cutoff = static_cast<float>(r.real(0.2, 0.8));
  mask.double_sided = true;
  scene.materials[1].base_color_texture = 1;
  scene.materials[1].metallic_roughness_texture = 2;
  scene.materials[1].normal_texture = 3;
  scene.materials[2].base_color = {0.3F, 0.8F, 0.2F, 1};
  scene.materials[2].metallic = 0.2F;
  for (std::uint32_t i = 0; i < 3; ++i) {
    scene.meshes[i].material = i;
    Mat4d m = Mat4d::identity();
    for (int k = 0; k < 3; ++k) m.m[k][k] = i == 0 ? 2.2 : 1;
    m.m[2][3] = i == 2 ? -3 : 0;
    scene.instances.push_back({i, m});
  }
  return scene;
}

class Materials : public testing::TestWithParam<float> {};

TEST_P(Materials, EqualOverTheFamily) {
  RenderOptions base({.width = 131,
                      .height = 99,
                      .shader = Shader::material,
                      .background = {0.3F, 0.7F, 0.1F, 0.6F},
                      .opacity = GetParam()});
  EveryWay ways(base);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = masked_scene(seed);
    const SceneBinding binding(scene);
    Camera camera = fit_camera(binding.view(), 1.0F, false);
    if (seed % 3 == 2) {  // inside the masked sphere
      camera.eye = {0.3F, 0.2F, 1.6F};
      camera.near_plane = 0.01F;
    }
    const Frame serial =
        ways.same([&](Painter& painter) { return draw(painter, binding.view(), camera); },
                  [](const Frame& got, const Frame& expected) {
                    EXPECT_TRUE(same_counts(got.stats, expected.stats));
                  });
    // The mask is seen through: some of what it covers belongs to what lies behind it.
    const auto sphere = static_cast<std::int64_t>(scene.meshes[0].triangle_count());
    int kept = 0, seen_through = 0;
    for (std::size_t i = 0; i < serial.ids.pixels().size(); ++i) {
      const std::int64_t id = serial.ids.pixels()[i];
      kept += id >= 0 && id < sphere;
      seen_through += id >= sphere;
    }
    EXPECT_GT(kept, 50);
    EXPECT_GT(seen_through, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(Opacity, Materials, testing::Values(1.0F, 0.4F),
                         [](const auto& p) { return p.param < 1 ? "Translucent" : "Opaque"; });

}  // namespace
}  // namespace rastrum::test::materials_test
