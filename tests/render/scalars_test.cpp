// SPDX-License-Identifier: BSD-3-Clause
// Scalars as colours (docs/scalar_rules.md), interpolated before they are mapped: against a float64
// oracle, for every kind of geometry; and refusals.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/pick.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/scene_checks.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/projection.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::scalars_test {
namespace {

constexpr int kW = 72, kH = 56;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A grey map: red is the number's place in the range.
ScalarMapping grey(double low, double high) {
  return {.map = {"grey", {{0, 0, 0, 1}, {1, 1, 1, 1}}, false}, .range = ScalarRange{low, high}};
}

Frame draw(const SceneView& scene, const Camera& camera, const RenderOptions& o) {
  return test::draw(o, scene, camera, kColor | kIds | kScalars);
}

RenderOptions flat(int w = kW, int h = kH) {
  return RenderOptions({.width = w, .height = h, .shader = Shader::flat}, {.threads = 1});
}

MeshView square(const ScalarView& values, Per per = Per::vertex) {
  return MeshView{.positions = kSquare, .indices = kTwoTriangles, .scalars = {values, per}};
}

SceneView scene_of(const InstanceView& instance, const ScalarMapping& mapping) {
  return {{&instance, 1}, {}, {}, {&mapping, 1}};
}

/// Draws with square_camera.
Frame draw(const InstanceView& instance, const ScalarMapping& mapping,
           const RenderOptions& o = flat()) {
  return draw(scene_of(instance, mapping), square_camera(), o);
}

TEST(Scalars, AreInterpolatedFirstAndMappedThen) {
  int checked = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const GeneratedScene g = generate(seed, kW, kH);
    SCOPED_TRACE(g.kind + " " + std::to_string(seed));
    std::vector<InstanceView> instances(g.view().instances.begin(), g.view().instances.end());
    std::deque<MeshView> meshes;
    Random random(seed);
    std::vector<std::vector<double>> values(instances.size());
    const Per per = static_cast<Per>(seed % 4);
    for (std::size_t i = 0; i < instances.size(); ++i) {
      MeshView& mesh = meshes.emplace_back(*instances[i].mesh());
      const std::size_t count = per == Per::vertex   ? mesh.positions.size()
                                : per == Per::corner ? mesh.corner_count()
                                : per == Per::face   ? mesh.face_count()
                                                     : 1;
      for (std::size_t v = 0; v < count; ++v) values[i].push_back(random.real(-3, 5));
      mesh.scalars = {values[i], per};
      instances[i].geometry = mesh;
      instances[i].color.reset();
    }
    const ScalarMapping mapping = grey(-3, 5);
    const SceneView scene{instances, {}, {}, {&mapping, 1}};
    const Frame p = draw(scene, g.camera, flat());
    const auto projected = project(scene, g.camera, kW, kH);
    for (const auto& [x, y] : pixels(kW, kH)) {
      if (p.ids(x, y) < 0) {
        ASSERT_TRUE(std::isnan(p.scalars(x, y)));
        continue;
      }
      const auto id = static_cast<std::size_t>(p.ids(x, y));
      const Located at = locate(scene, id);
      const MeshView& mesh = *instances[at.instance].mesh();
      const std::vector<double>& v = values[at.instance];
      const auto t = static_cast<std::size_t>(at.primitive);
      const auto a = exact_weights(projected[id], kW, kH, x, y);
      const Real sum = a[0] + a[1] + a[2];
      if (std::ranges::any_of(a, [&](Real w) { return !(w / sum >= 0); })) continue;
      Real value = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t element = per == Per::vertex   ? mesh.vertex(3 * t + c)
                                    : per == Per::corner ? 3 * t + c
                                    : per == Per::face   ? t
                                                         : 0;
        value += a[c] / sum * v[element];
      }
      ASSERT_NEAR(p.scalars(x, y), static_cast<double>(value), 1e-5) << x << ", " << y;
      ASSERT_NEAR(p.color(x, y).x, static_cast<double>((value + 3) / 8), 2e-6) << x << ", " << y;
      ++checked;
    }
  }
  EXPECT_GT(checked, 50000);
}

// 64 bands over two triangles. Blending the colours of the four corners would show none of them.
TEST(Scalars, AreNotSmearedByASteepMap) {
  const std::vector<float> values{0, 1, 1, 0};
  ScalarMapping mapping = grey(0, 1);
  mapping.steps = 64;
  const Frame p = draw(OneInstance(square(values)), mapping, flat(256, 256));
  for (const auto& [x, y] : pixels(256, 256))
    ASSERT_EQ(p.color(x, y).x, static_cast<float>(x / 4 / 63.0)) << x << ", " << y;
}

TEST(Scalars, OfWhatIsNoNumberHaveItsColour) {
  const std::vector<double> values{0, kNan, 1, 0};
  ScalarMapping mapping = grey(0, 1);
  mapping.nan = {1, 0, 0, 1};
  const Frame p = draw(OneInstance(square(values)), mapping, flat(64, 64));
  EXPECT_EQ(p.color(50, 60), mapping.nan);  // of the triangle with that corner
  EXPECT_TRUE(std::isnan(p.scalars(50, 60)));
  EXPECT_EQ(p.color(2, 2).y, p.color(2, 2).x);
  EXPECT_FALSE(std::isnan(p.scalars(2, 2)));
}

TEST(Scalars, OfThreeEqualCornersAreExactlyThat) {
  // 0.1 has no exact binary form. If the range ends there, no colour of values beyond may show.
  const std::vector<double> values{0.1, 0.1, 0.1, 0.1};
  ScalarMapping mapping = grey(-1, 0.1);
  mapping.above = Vec4{1, 0, 0, 1};
  const Frame p = draw(OneInstance(square(values)), mapping);
  for (int y = 0; y < kH; ++y)
    for (int x = 10; x < kW - 10; ++x) ASSERT_EQ(p.color(x, y), (Vec4{1, 1, 1, 1}));
}

TEST(Scalars, OfAnInstanceStandForItsGeometrys) {
  const std::vector<float> values{0, 1, 1, 0};
  OneInstance instance(square(values));
  instance.scalar = 0.25;
  const Frame p = draw(instance, grey(0, 1));
  EXPECT_EQ(p.color(kW / 2, kH / 2), (Vec4{0.25F, 0.25F, 0.25F, 1}));
  EXPECT_EQ(p.scalars(kW / 2, kH / 2), 0.25F);
}

// Alike instances are one draw (scene/instance_runs.hpp); one with numbers stands between them.
TEST(Scalars, StandBetweenRunsOfAlikeInstances) {
  MeshView mesh{.positions = kSquare, .indices = kTwoTriangles};
  std::vector<InstanceView> instances(8);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    instances[i].geometry = mesh;
    instances[i].object_to_world =
        translation({static_cast<double>(i) / 8, 0, 0}) * scaling({0.125, 1, 1});
  }
  instances[3].scalar = 0.25;
  instances[6].scalar = 0.75;
  const ScalarMapping mapping = grey(0, 1);
  const SceneView scene{instances, {}, {}, {&mapping, 1}};
  for (const Shader shader : {Shader::flat, Shader::material}) {
    RenderOptions o = flat(64, 64);
    o.shader = shader;
    const Frame p = draw(scene, square_camera(), o);
    for (int i = 0; i < 8; ++i) {
      const float expected = i == 3 ? 0.25F : i == 6 ? 0.75F : std::nanf("");
      const float got = p.scalars(8 * i + 4, 32);
      EXPECT_TRUE(got == expected || (std::isnan(got) && std::isnan(expected))) << i;
      const Vec4 c = p.color(8 * i + 4, 32), plain = p.color(4, 32);
      if (std::isnan(expected)) {
        EXPECT_EQ(c, plain) << i;
      } else if (shader == Shader::flat) {
        EXPECT_EQ(c, (Vec4{expected, expected, expected, 1})) << i;
      } else {
        EXPECT_NE(c, plain) << i;
      }
      EXPECT_EQ(p.ids(8 * i + 4, 32) / 2, i);
    }
  }
}

TEST(Scalars, HaveAMappingEachInstanceChooses) {
  const std::vector<float> values{0, 1, 1, 0};
  const MeshView mesh = square(values);
  std::vector<InstanceView> instances(2, InstanceView{mesh});
  instances[0].object_to_world = scaling({0.5, 1, 1});
  instances[1].object_to_world = translation({0.5, 0, 0}) * scaling({0.5, 1, 1});
  instances[0].scalar = 1;
  instances[1].scalar = 1;
  instances[1].scalar_mapping = 1;
  const std::vector<ScalarMapping> mappings{grey(0, 2), grey(0, 4)};
  const SceneView scene{instances, {}, {}, mappings};
  const Frame p = draw(scene, square_camera(), flat(64, 64));
  EXPECT_EQ(p.color(16, 32).x, 0.5F);
  EXPECT_EQ(p.color(48, 32).x, 0.25F);
}

// The automatic range covers the instances that use the mapping.
TEST(Scalars, HaveTheRangeOfTheirFiniteNumbers) {
  const std::vector<double> values{3, 7, 7, kNan};
  const OneInstance instance(square(values));
  ScalarMapping mapping = grey(0, 1);
  mapping.range.reset();
  const SceneView scene = scene_of(instance, mapping);
  EXPECT_EQ(scalar_colors(scene).range(), (ScalarRange{3, 7}));
  const Frame p = draw(scene, square_camera(), flat(64, 64));
  EXPECT_NEAR(p.color(32, 60).x, 32.5 / 64, 1e-6);
}

TEST(Scalars, OfEveryGeometry) {
  const ScalarMapping mapping = grey(0, 8);
  const std::vector<Vec3> ends{{0.1F, 0.5F, 0}, {0.9F, 0.5F, 0}};
  const std::vector<Vec3> up{{0, 0, 1}, {0, 0, 1}};
  const std::vector<std::int16_t> values{2, 6};
  const auto at = [&](const GeometryView& geometry, int x, int y) {
    InstanceView instance{.geometry = geometry};
    const SceneView scene = scene_of(instance, mapping);
    const Frame p = draw(scene, square_camera(), flat(101, 101));
    EXPECT_GE(p.ids(x, y), 0);
    EXPECT_NEAR(p.color(x, y).x, p.scalars(x, y) / 8, 1e-6);
    EXPECT_EQ(p.color(x, y).y, p.color(x, y).x);
    const auto pick =
        Renderer({.threads = 1}).pick(scene, square_camera(), {.width = 101, .height = 101}, x, y);
    EXPECT_TRUE(pick && pick->scalar);
    if (pick && pick->scalar) {
      EXPECT_EQ(static_cast<float>(*pick->scalar), p.scalars(x, y));
    }
    return p.scalars(x, y);
  };
  PointsView points{.positions = ends, .point_size = 9, .scalars = values};
  EXPECT_EQ(at(points, 10, 50), 2);
  EXPECT_EQ(at(points, 90, 50), 6);
  LinesView lines{.positions = ends, .line_width = 3, .scalars = values};
  EXPECT_NEAR(at(lines, 50, 50), 4, 1e-4);
  EXPECT_NEAR(at(lines, 30, 50), 3, 1e-2);
  SpheresView spheres{.centers = ends, .radius = 0.1F, .scalars = values};
  EXPECT_EQ(at(spheres, 10, 50), 2);
  EXPECT_EQ(at(spheres, 93, 52), 6);
  CylindersView cylinders{.positions = ends, .radius = 0.1F, .scalars = values};
  EXPECT_NEAR(at(cylinders, 50, 50), 4, 1e-5);
  EXPECT_NEAR(at(cylinders, 30, 53), 2 + 4 * (30.5 / 101 - 0.1) / 0.8, 1e-4);
  TubesView tubes{.positions = ends, .radius = 0.05F, .scalars = values};
  EXPECT_NEAR(at(tubes, 30, 50), 2 + 4 * (30.5 / 101 - 0.1) / 0.8, 1e-4);
  DiscsView discs{.centers = ends, .normals = up, .radius = 0.1F, .scalars = values};
  EXPECT_EQ(at(discs, 90, 50), 6);
}

TEST(Scalars, OfOpacityAreLayersInOrder) {
  const std::vector<float> values{0, 0, 0, 0};
  const MeshView mesh = square(values);
  std::vector<InstanceView> instances(2, InstanceView{mesh});
  instances[0].object_to_world = translation({0, 0, 0.2});
  instances[0].scalar = 1;  // in front: white, a quarter of it
  instances[1].scalar = 0;
  ScalarMapping mapping = grey(0, 1);
  mapping.map.colors[0] = {0, 1, 0, 1};
  mapping.opacity = {{0, 1}, {1, 0.25F}};
  RenderOptions o = flat();
  o.background = {0, 0, 0, 1};
  const SceneView scene{instances, {}, {}, {&mapping, 1}};
  const auto middle = [&] { return draw(scene, square_camera(), o).color(kW / 2, kH / 2); };
  EXPECT_EQ(middle(), (Vec4{0.25F, 1, 0.25F, 1}));
  o.samples = 4;
  EXPECT_EQ(middle(), (Vec4{0.25F, 1, 0.25F, 1}));
  o.transparency.method = Transparency::none;
  EXPECT_EQ(middle(), (Vec4{1, 1, 1, 1}));
}

TEST(Scalars, KeepTheHolesOfMasks) {
  const std::vector<float> values{0, 1, 1, 0};
  const std::vector<Vec2> texcoords{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  MeshView mesh = square(values);
  mesh.texcoords.values = texcoords;
  Texture texture{.image = Image<Rgba8>(2, 1)};
  texture.image(0, 0) = {255, 0, 0, 255};
  texture.image(1, 0) = {255, 0, 0, 0};
  texture.mag = texture.min = TextureFilter::nearest;
  texture.mipmaps = false;
  Material material{.base_color_texture = 0, .alpha_mode = AlphaMode::mask, .double_sided = true};
  const InstanceView instance{mesh};
  const ScalarMapping mapping = grey(0, 1);
  const SceneView scene{{&instance, 1}, {&material, 1}, {&texture, 1}, {&mapping, 1}};
  for (const Shader shader : {Shader::flat, Shader::material}) {
    RenderOptions o = flat(64, 64);
    o.shader = shader;
    const Frame p = draw(scene, square_camera(), o);
    EXPECT_GE(p.ids(16, 32), 0);
    EXPECT_EQ(p.ids(48, 32), -1);
    if (shader == Shader::flat) {
      EXPECT_NEAR(p.color(16, 32).x, 16.5 / 64, 1e-6);
    }
  }
}

TEST(Scalars, AreColouredInLinearLightByMaterials) {
  const std::vector<float> values{0.5F, 0.5F, 0.5F, 0.5F};
  Material material{.base_color = {1, 0, 0, 1}, .unlit = true};
  const MeshView mesh = square(values);
  const InstanceView instance{mesh};
  const ScalarMapping mapping = grey(0, 1);
  const SceneView scene{{&instance, 1}, {&material, 1}, {}, {&mapping, 1}};
  RenderOptions o = flat();
  o.shader = Shader::material;
  const Frame p = test::draw(o, scene, square_camera(), kColor | kAlbedo);
  const Vec4 c = p.color(kW / 2, kH / 2), a = p.albedo(kW / 2, kH / 2);
  EXPECT_NEAR(c.x, 0.5, 5e-5);  // as precise as the transfer function's inverse
  EXPECT_EQ(c.x, c.y);
  EXPECT_NEAR(a.x, 0.21404114, 1e-7);
  EXPECT_EQ(a.w, 1);
}

TEST(Scalars, OfNothingChangeNoBit) {
  const Fitted sphere(shapes::scene_from_spec("sphere?segments=24"), 1);
  const Camera& camera = sphere.camera;
  RenderOptions o = flat();
  o.shader = Shader::phong;
  const auto without = digest(render(sphere.view, camera, o));
  const ScalarMapping mapping;
  SceneView scene = sphere.view;
  scene.scalar_mappings = {&mapping, 1};
  EXPECT_EQ(without, digest(render(scene, camera, o)));
  // Without a mapping, numbers go only to their target.
  InstanceView instance = scene.instances[0];
  instance.scalar = 3;
  const SceneView numbered{{&instance, 1}, {}, {}, {}};
  EXPECT_EQ(without, digest(render(numbered, camera, o)));
  EXPECT_EQ(draw(numbered, camera, o).scalars(kW / 2, kH / 2), 3);
}

TEST(Scalars, AreTheHostsToColour) {
  const std::vector<float> values{0, 1, 1, 0};
  const OneInstance instance(square(values));
  const ScalarMapping mapping;
  SceneView scene = scene_of(instance, mapping);
  EXPECT_TRUE(holds(why_not_on_device(scene), "instance 0 shows scalars"));
  scene.scalar_mappings = {};
  EXPECT_EQ(why_not_on_device(scene), "");
}

TEST(Scalars, RefuseWhatDoesNotFit) {
  const std::vector<float> values{0, 1, 1};
  const ScalarMapping mapping;
  const auto refuse = [&](const char* part, const GeometryView& geometry) {
    expect_refused(part, [&] { (void)draw({geometry}, mapping); });
  };
  refuse("instance 0: scalars are fewer (3) than positions (4)", square(values));
  refuse("instance 0: scalars are fewer (3) than corners (6)", square(values, Per::corner));
  refuse("scalars.per", square(values, static_cast<Per>(9)));
  refuse("scalars are fewer (3)", PointsView{.positions = kSquare, .scalars = values});
  refuse("scalars are fewer (3)", LinesView{.positions = kSquare, .scalars = values});
  refuse("scalars are fewer (3) than spheres (4)",
         SpheresView{.centers = kSquare, .scalars = values});
  refuse("scalars are fewer (3) than positions (4)",
         TubesView{.positions = kSquare, .scalars = values});
  OneInstance instance(square(std::span<const float>{}));
  instance.scalar = 1;
  instance.scalar_mapping = 1;
  expect_refused("instance 0: scalar mapping 1 is out of range, there are 1",
                 [&] { (void)draw(instance, mapping); });
  instance.scalar_mapping = 0;
  const ScalarMapping upside_down{.range = ScalarRange{1, 0}};
  expect_refused("ScalarMapping::range: upside down", [&] { (void)draw(instance, upside_down); });
  ScalarMapping log{.logarithmic = true};
  instance.scalar = -1;  // negative numbers have no logarithm: the colour of NaN
  EXPECT_EQ(draw(instance, log).color(kW / 2, kH / 2), log.nan);
}

}  // namespace
}  // namespace rastrum::test::scalars_test
