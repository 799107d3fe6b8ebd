// SPDX-License-Identifier: BSD-3-Clause
// Materials over the family: textures, alpha masks (fragments are tested before the maximum) and
// several instances. Ids, depth and coverage have the same bits everywhere, colours on one
// instruction set. Material::opacity equals the frame's opacity for a part of the scene.
#include <limits>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test::materials_test {
namespace {

Texture noise(Random& r, int size) {
  const auto byte = [&] { return static_cast<std::uint8_t>(r.integer(0, 255)); };
  return texture(size, size, [&](int, int) { return Rgba8{byte(), byte(), byte(), byte()}; });
}

FrameOptions frame_of(Shader shader, float opacity) {
  return {.width = 131,
          .height = 99,
          .shader = shader,
          .background = {0.3F, 0.7F, 0.1F, 0.6F},
          .opacity = opacity};
}

// A sphere with holes by a mask, around an opaque knot and in front of a wall of boxes.
Scene masked_scene(std::uint64_t seed) {
  Random r(seed);
  Scene scene;
  scene.meshes = {shapes::sphere(10, 20), shapes::torus_knot(2, 3, 60, 8), shapes::boxes(3)};
  for (int i = 0; i < 4; ++i) scene.textures.push_back(noise(r, 1 << r.integer(0, 5)));
  scene.materials.resize(3);
  Material& mask = scene.materials[0];
  mask.base_color_texture = 0;
  mask.alpha_mode = AlphaMode::mask;
  mask.alpha_cutoff = r.real32(0.2, 0.8);
  mask.double_sided = true;
  scene.materials[1].base_color_texture = 1;
  scene.materials[1].metallic_roughness_texture = 2;
  scene.materials[1].normal_texture = 3;
  scene.materials[2].base_color = {0.3F, 0.8F, 0.2F, 1};
  scene.materials[2].metallic = 0.2F;
  scene.materials[1].classic.shininess = 0.03F;
  scene.materials[2].classic.shininess = 0.71F;
  for (std::uint32_t i = 0; i < 3; ++i) {
    scene.meshes[i].material = i;
    Mat4d m = Mat4d::identity();
    for (int k = 0; k < 3; ++k) m.m[k][k] = i == 0 ? 2.2 : 1;
    m.m[2][3] = i == 2 ? -3 : 0;
    scene.instances.push_back({i, m});
  }
  return scene;
}

class Materials : public testing::TestWithParam<std::tuple<Shader, float>> {};

TEST_P(Materials, EqualOverTheFamily) {
  EveryWay ways(RenderOptions(frame_of(std::get<0>(GetParam()), std::get<1>(GetParam()))));
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = masked_scene(seed);
    const Fitted fitted(scene, 1);
    Camera camera = fitted.camera;
    if (seed % 3 == 2) {  // inside the masked sphere
      camera.eye = {0.3F, 0.2F, 1.6F};
      camera.near_plane = 0.01F;
    }
    const Frame serial =
        ways.same([&](Painter& painter) { return draw(painter, fitted.view, camera); }, kCountsToo);
    // The mask has holes: some pixels inside of it show what is behind.
    const auto sphere = static_cast<std::int64_t>(scene.meshes[0].triangle_count());
    int kept = 0, seen_through = 0;
    for (const std::int64_t id : serial.ids.pixels()) {
      kept += id >= 0 && id < sphere;
      seen_through += id >= sphere;
    }
    EXPECT_GT(kept, 50);
    EXPECT_GT(seen_through, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(Opacity, Materials,
                         testing::Combine(testing::Values(Shader::material, Shader::classic),
                                          testing::Values(1.0F, 0.4F)),
                         [](const auto& p) {
                           return std::string(name(std::get<0>(p.param))) +
                                  (std::get<1>(p.param) < 1 ? "Translucent" : "Opaque");
                         });

RenderOptions options(Shader shader, float opacity, Isa isa) {
  return RenderOptions(frame_of(shader, opacity), {.isa = isa});
}

Frame drawn(const Scene& scene, const RenderOptions& o) {
  const Fitted fitted(scene, 1);
  return draw(o, fitted.view, fitted.camera);
}

/// Textured, masked, with vertex alpha; material 2 blends.
Scene scene_with(float opacity) {
  Scene scene = everything();
  scene.materials[2].alpha_mode = AlphaMode::blend;
  for (Material& m : scene.materials) m.opacity = opacity;
  return scene;
}

TEST(MaterialOpacity, OfAllMaterialsIsTheOpacityOfTheFrame) {
  for (const Isa isa : available_isas())
    for (const Shader shader : {Shader::material, Shader::phong}) {
      SCOPED_TRACE(name(isa));
      const Frame frame = drawn(scene_with(1), options(shader, 0.25F, isa));
      EXPECT_TRUE(same_picture(drawn(scene_with(0.25F), options(shader, 1, isa)), frame, 0));
      EXPECT_TRUE(same_picture(drawn(scene_with(0.5F), options(shader, 0.5F, isa)), frame, 0))
          << "they are multiplied";
      EXPECT_FALSE(same_picture(drawn(scene_with(1), options(shader, 1, isa)), frame, 0));
    }
}

TEST(MaterialOpacity, IsOfItsMaterialAlone) {
  const RenderOptions o = options(Shader::flat, 1, Isa::scalar);
  Scene scene = everything();  // none blends
  Scene glass = scene;
  glass.materials[0].opacity = 0.5F;
  const Frame solid = drawn(scene, o), frame = drawn(glass, o);
  int through = 0;
  for (std::size_t i = 0; i < frame.ids.pixels().size(); ++i) {
    const std::int64_t id = frame.ids.pixels()[i];
    EXPECT_EQ(id, solid.ids.pixels()[i]) << "the nearest surface, whatever its alpha";
    if (id < 0) continue;
    const bool changed = frame.color8.pixels()[i] != solid.color8.pixels()[i];
    EXPECT_TRUE(!changed || id % 4 == 0) << "triangle " << id;
    through += changed;
  }
  EXPECT_GT(through, 100);
}

TEST(MaterialOpacity, RefusesWhatIsNone) {
  for (const float opacity : {-0.1F, 1.5F, std::numeric_limits<float>::quiet_NaN()}) {
    Scene scene = everything();
    scene.materials[1].opacity = opacity;
    EXPECT_THROW((void)drawn(scene, options(Shader::flat, 1, Isa::scalar)), Error);
  }
}

}  // namespace
}  // namespace rastrum::test::materials_test
