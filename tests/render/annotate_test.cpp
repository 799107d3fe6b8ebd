// SPDX-License-Identifier: BSD-3-Clause
// A frame and its annotations in one call: the same bits as from single functions. Only colours
// change, and nothing depends on threads, instruction sets or earlier contents of the images.
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::annotate_test {
namespace {

constexpr int kW = 96, kH = 72;

struct Subject {
  Scene scene = shapes::scene_from_spec("boxes?count=2");
  Camera camera;

  Subject() {
    show_scalars(scene, "z");
    scene.scalar_mappings = {ScalarMapping{}};
    camera = fit_picture(SceneBinding(scene).view(), {.eye = {3, 2, 4}}, kW, kH);
  }
};

const FrameOptions kFrame{
    .width = kW, .height = kH, .shader = Shader::phong, .background = {1, 1, 1, 1}};

Annotations everything() {
  Annotations a{.occlusion = AmbientOcclusion{.radius = 0.4}, .dome = EyeDome{.radius_px = 0}};
  a.silhouettes.emplace();
  a.edges = {20, 1.5};
  a.bounds = a.axes = true;
  a.bar = {"Height", "m", true};
  a.title = "Title";
  a.captions = {"one", "two", "three", "four"};
  a.text_scale = 1.5;
  return a;
}

constexpr unsigned kColors = kColor8 | kColor;
constexpr unsigned kAll = kColors | kDepth | kIds | kInstances | kNormals | kViewDepth;

Frame annotated(const Subject& s, const Annotations& a, unsigned kinds = kColors, int threads = 0,
                std::optional<Isa> isa = {}) {
  Renderer renderer({.threads = threads, .isa = isa});
  Annotator annotator(threads, isa);
  Frame frame(kW, kH, kinds);
  annotator.render(renderer, SceneBinding(s.scene).view(), s.camera, kFrame, a, frame.targets());
  return frame;
}

TEST(Annotator, DrawsWhatTheFunctionsDrawOneByOne) {
  const Subject s;
  const SceneBinding binding(s.scene);
  const SceneView scene = binding.view();
  Renderer renderer;
  Frame f = draw(renderer, scene, s.camera, kFrame, kAll);
  Image<float> factor(kW, kH);
  Effects effects;
  const Surface surface{f.view_depth, f.normals, f.instances};
  const auto darken = [&] { effects.darken(f.color8, f.color, factor.view()); };
  effects.ambient_occlusion({.view_depth = f.view_depth}, s.camera, {.radius = 0.4}, factor);
  darken();
  effects.eye_dome(surface, s.camera, {.radius_px = 1}, factor);
  darken();
  effects.silhouettes(surface, s.camera, {}, factor);
  darken();
  effects.edges(f.ids, SceneEdges(scene, 20), s.camera, 1.5, factor);
  darken();
  const overlay::Canvas canvas{f.color8, f.color};
  overlay::Look look = overlay::look_on({1, 1, 1, 1});
  look.scale = 1.5;
  const Bounds box = bounds(scene);
  overlay::draw_bounds(canvas, s.camera, box.min, box.max, f.depth, look);
  overlay::draw_axes(canvas, s.camera, overlay::Corner::bottom_left, look);
  overlay::ScalarBar bar = overlay::scalar_bar(s.scene.scalar_mappings[0], scalar_colors(scene));
  bar.title = "Height";
  bar.unit = "m";
  bar.nan = s.scene.scalar_mappings[0].nan;
  overlay::draw_scalar_bar(canvas, bar, look);
  overlay::draw_title(canvas, "Title", look);
  overlay::draw_caption(canvas, "one", overlay::Corner::bottom_right, look);
  overlay::draw_caption(canvas, "two", overlay::Corner::top_left, look);
  overlay::draw_caption(canvas, "three", overlay::Corner::top_right, look);
  overlay::draw_caption(canvas, "four", overlay::Corner::bottom_left, look);
  EXPECT_TRUE(same_images(annotated(s, everything()), f, kColors));
}

TEST(Annotator, DrawsTheSameWithAnyThreadsAndInstructionSet) {
  const Subject s;
  const Frame expected = annotated(s, everything(), kColors, 1, Isa::scalar);
  for (const Isa isa : available_isas())
    EXPECT_TRUE(same_images(annotated(s, everything(), kColors, 3, isa), expected)) << name(isa);
}

TEST(Annotator, ChangesColorsAlone) {
  const Subject s;
  const Frame plain = annotated(s, {}, kAll), noted = annotated(s, everything(), kAll);
  EXPECT_FALSE(same_images(plain, noted, kColor8));
  EXPECT_FALSE(same_images(plain, noted, kColor));
  EXPECT_TRUE(same_images(plain, noted, kAll & ~kColors));
}

TEST(Annotator, KeepsNothingOfAnotherFrame) {
  const Subject s;
  const SceneBinding binding(s.scene);
  const Frame expected = annotated(s, everything());
  Renderer renderer;
  Annotator annotator;
  // Draws another size and scene before this one; in one call or two, with edges made before.
  Image<Rgba8> small(20, 30);
  Annotations other = everything();
  other.bar.reset();
  const Scene ball = shapes::scene_from_spec("sphere");
  annotator.render(renderer, SceneBinding(ball).view(), s.camera, {.width = 20, .height = 30},
                   other, {.color8 = small});
  Frame one(kW, kH, kColors), two(kW, kH, kColors);
  const SceneEdges edges(binding.view(), 20);
  annotator.render(renderer, binding.view(), s.camera, kFrame, everything(), one.targets(), &edges);
  EXPECT_TRUE(same_images(one, expected));
  Targets targets = two.targets();
  annotator.add_targets(everything(), kW, kH, targets);
  renderer.render(binding.view(), s.camera, kFrame, targets);
  annotator.draw(everything(), binding.view(), s.camera, kFrame.background, targets);
  EXPECT_TRUE(same_images(two, expected));
}

TEST(Annotator, FindsSizesThatNobodyGave) {
  const Subject s;
  // Boxes from about −1 to 1: the radius is that of a sphere around the corners, and 72 / 360 < 1
  // px.
  const SceneBinding binding(s.scene);
  const double radius = fit_camera(binding.view(), 1, true).orthographic_height / 2;
  Annotations given, own;
  given.occlusion = AmbientOcclusion{.radius = 0.15 * radius};
  own.occlusion.emplace();
  given.dome = EyeDome{.radius_px = 1};
  own.dome = EyeDome{.radius_px = 0};
  const Frame a = annotated(s, given), b = annotated(s, own);
  for (std::size_t i = 0; i < a.color8.pixels().size(); ++i)
    ASSERT_NEAR(a.color8.pixels()[i].r, b.color8.pixels()[i].r, 1);
}

TEST(Annotator, RefusesWhatCannotBeDrawn) {
  Renderer renderer;
  Annotator annotator;
  const Subject subject;
  const auto refused = [&](const char* part, const Annotations& a, const Scene& scene,
                           unsigned kinds = kColors) {
    Frame frame(kW, kH, kinds);
    expect_refused(part, [&] {
      annotator.render(renderer, SceneBinding(scene).view(), subject.camera, kFrame, a,
                       frame.targets());
    });
  };
  refused("color8", everything(), subject.scene, kDepth);
  Annotations five = everything();
  five.captions.emplace_back("five");
  refused("captions", five, subject.scene);
  Annotations large = everything();
  large.text_scale = 101;
  refused("text_scale", large, subject.scene);
  refused("bar", everything(), shapes::scene_from_spec("sphere"));
}

TEST(Annotator, LeavesRoomForNumbers) {
  const Scene sphere = shapes::scene_from_spec("sphere");
  const SceneBinding binding(sphere);
  const Camera camera = fit_picture(binding.view(), {.fov_rad = 1}, 300, 200);
  const auto seen = [&](const Annotations& a) {
    return std::tan(with_room(a, camera, binding.view(), 300, 200).fov_rad / 2) /
           std::tan(camera.fov_rad / 2);
  };
  Annotations a;
  EXPECT_EQ(with_room(a, camera, binding.view(), 300, 200).fov_rad, camera.fov_rad);
  a.bar.emplace();
  EXPECT_NEAR(seen(a), 1.25, 1e-6);
  a.bounds = true;
  const Bounds box = bounds(binding.view());
  const double room = overlay::room_for_bounds(camera, box.min, box.max, 300, 200);
  EXPECT_GT(room, 1.3);
  EXPECT_NEAR(seen(a), room, 1e-6);
  // An empty scene has no box.
  EXPECT_NEAR(std::tan(with_room(a, camera, SceneView{}, 300, 200).fov_rad / 2) /
                  std::tan(camera.fov_rad / 2),
              1.25, 1e-6);
}

}  // namespace
}  // namespace rastrum::test::annotate_test
