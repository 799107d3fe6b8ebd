// Material::opacity is RenderOptions::opacity for a part of the scene.
#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test::material_opacity_test {
namespace {

RenderOptions options(Shader shader, float opacity, Isa isa) {
  return RenderOptions({.width = 131,
                        .height = 99,
                        .shader = shader,
                        .background = {0.3F, 0.7F, 0.1F, 0.6F},
                        .opacity = opacity},
                       {.isa = isa});
}

Frame drawn(const Scene& scene, const RenderOptions& o) {
  const SceneBinding binding(scene);
  Painter renderer(o);
  return draw(renderer, binding.view(), fit_camera(binding.view(), 1, false));
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
}  // namespace rastrum::test::material_opacity_test
