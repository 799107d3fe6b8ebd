// A frame and what is drawn over it in one call: the same bits as the functions one by one, colours
// alone change, and nothing depends on threads, instruction sets or what lay in the images before.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>
#include <rastrum/digest.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/shapes.hpp>

#include <tests/support/isa.hpp>

namespace rastrum::annotate_test {
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

struct Colors {
  Image<Rgba8> color8{kW, kH};
  Image<Vec4> color{kW, kH};

  [[nodiscard]] Targets targets() { return {.color8 = color8, .color = color}; }
  [[nodiscard]] std::string digests() const { return digest(color8).hex() + digest(color).hex(); }
};

std::string annotated(const Subject& s, const Annotations& a, int threads = 0,
                      std::optional<Isa> isa = {}) {
  Renderer renderer({.threads = threads, .isa = isa});
  Annotator annotator(threads, isa);
  Colors colors;
  annotator.render(renderer, SceneBinding(s.scene).view(), s.camera, kFrame, a, colors.targets());
  return colors.digests();
}

TEST(Annotator, DrawsWhatTheFunctionsDrawOneByOne) {
  const Subject s;
  const SceneBinding binding(s.scene);
  const SceneView scene = binding.view();
  Colors colors;
  Image<float> view_depth(kW, kH), depth(kW, kH), factor(kW, kH);
  Image<Vec3> normals(kW, kH);
  Image<std::int64_t> ids(kW, kH), instances(kW, kH);
  Targets targets = colors.targets();
  targets.depth = depth;
  targets.ids = ids;
  targets.instances = instances;
  targets.camera_normals = normals;
  targets.view_depth = view_depth;
  Renderer renderer;
  renderer.render(scene, s.camera, kFrame, targets);

  Effects effects;
  const Surface surface{view_depth, normals, instances};
  const auto darken = [&] { effects.darken(colors.color8, colors.color, factor.view()); };
  effects.ambient_occlusion({.view_depth = view_depth}, s.camera, {.radius = 0.4}, factor);
  darken();
  effects.eye_dome(surface, s.camera, {.radius_px = 1}, factor);
  darken();
  effects.silhouettes(surface, s.camera, {}, factor);
  darken();
  effects.edges(ids, SceneEdges(scene, 20), s.camera, 1.5, factor);
  darken();
  const overlay::Canvas canvas{colors.color8, colors.color};
  overlay::Look look = overlay::look_on({1, 1, 1, 1});
  look.scale = 1.5;
  const Bounds box = bounds(scene);
  overlay::draw_bounds(canvas, s.camera, box.min, box.max, depth, look);
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
  EXPECT_EQ(annotated(s, everything()), colors.digests());
}

TEST(Annotator, DrawsTheSameWithAnyThreadsAndInstructionSet) {
  const Subject s;
  const std::string expected = annotated(s, everything(), 1, Isa::scalar);
  for (const Isa isa : available_isas()) EXPECT_EQ(annotated(s, everything(), 3, isa), expected);
}

TEST(Annotator, ChangesColorsAlone) {
  const Subject s;
  const SceneBinding binding(s.scene);
  const auto drawn = [&](const Annotations& a) {
    Colors colors;
    Image<float> depth(kW, kH), view_depth(kW, kH);
    Image<std::int64_t> ids(kW, kH), instances(kW, kH);
    Image<Vec3> normals(kW, kH);
    Targets targets = colors.targets();
    targets.depth = depth;
    targets.ids = ids;
    targets.instances = instances;
    targets.camera_normals = normals;
    targets.view_depth = view_depth;
    Renderer renderer;
    Annotator annotator;
    annotator.render(renderer, binding.view(), s.camera, kFrame, a, targets);
    return std::vector<Digest>{digest(colors.color8), digest(colors.color), digest(depth),
                               digest(view_depth),    digest(ids),          digest(instances),
                               digest(normals)};
  };
  const auto plain = drawn({}), noted = drawn(everything());
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(plain[i] == noted[i], i >= 2) << i;
}

TEST(Annotator, KeepsNothingOfAnotherFrame) {
  const Subject s;
  const SceneBinding binding(s.scene);
  const std::string expected = annotated(s, everything());
  Renderer renderer;
  Annotator annotator;
  // Another size, another scene, then that one; in one call, in two, with edges made before.
  Image<Rgba8> small(20, 30);
  Annotations other = everything();
  other.bar.reset();
  const Scene ball = shapes::scene_from_spec("sphere");
  annotator.render(renderer, SceneBinding(ball).view(), s.camera, {.width = 20, .height = 30},
                   other, {.color8 = small});
  Colors one, two;
  const SceneEdges edges(binding.view(), 20);
  annotator.render(renderer, binding.view(), s.camera, kFrame, everything(), one.targets(), &edges);
  EXPECT_EQ(one.digests(), expected);
  Targets targets = two.targets();
  annotator.add_targets(everything(), kW, kH, targets);
  renderer.render(binding.view(), s.camera, kFrame, targets);
  annotator.draw(everything(), binding.view(), s.camera, kFrame.background, targets);
  EXPECT_EQ(two.digests(), expected);
}

TEST(Annotator, FindsSizesThatNobodyGave) {
  const Subject s;
  // Boxes from −1 to 1 or so: the radius of a sphere around the corners, and 72 / 360 < 1 px.
  const SceneBinding binding(s.scene);
  const double radius = fit_camera(binding.view(), 1, true).orthographic_height / 2;
  Annotations given, own;
  given.occlusion = AmbientOcclusion{.radius = 0.15 * radius};
  own.occlusion.emplace();
  given.dome = EyeDome{.radius_px = 1};
  own.dome = EyeDome{.radius_px = 0};
  Colors a, b;
  Renderer renderer;
  Annotator annotator;
  annotator.render(renderer, binding.view(), s.camera, kFrame, given, a.targets());
  annotator.render(renderer, binding.view(), s.camera, kFrame, own, b.targets());
  for (std::size_t i = 0; i < a.color8.pixels().size(); ++i)
    ASSERT_NEAR(a.color8.pixels()[i].r, b.color8.pixels()[i].r, 1);
}

TEST(Annotator, RefusesWhatCannotBeDrawn) {
  const Subject s;
  const SceneBinding binding(s.scene);
  Renderer renderer;
  Annotator annotator;
  Colors colors;
  Image<float> depth(kW, kH);
  const auto refused = [&](const Annotations& a, const SceneView& scene, const Targets& targets) {
    try {
      annotator.render(renderer, scene, s.camera, kFrame, a, targets);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("nothing was refused");
  };
  EXPECT_NE(refused(everything(), binding.view(), {.depth = depth}).find("color8"),
            std::string::npos);
  Annotations five = everything();
  five.captions.emplace_back("five");
  EXPECT_NE(refused(five, binding.view(), colors.targets()).find("captions"), std::string::npos);
  Annotations large = everything();
  large.text_scale = 101;
  EXPECT_NE(refused(large, binding.view(), colors.targets()).find("text_scale"), std::string::npos);
  const Scene plain = shapes::scene_from_spec("sphere");
  EXPECT_NE(refused(everything(), SceneBinding(plain).view(), colors.targets()).find("bar"),
            std::string::npos);
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
  // Nothing has no box.
  EXPECT_NEAR(std::tan(with_room(a, camera, SceneView{}, 300, 200).fov_rad / 2) /
                  std::tan(camera.fov_rad / 2),
              1.25, 1e-6);
}

}  // namespace
}  // namespace rastrum::annotate_test
