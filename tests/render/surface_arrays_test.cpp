// SPDX-License-Identifier: BSD-3-Clause
// The arrays of spheres, cylinders, tubes, discs, points and lines: the same bits for all types and
// strides. float64 positions stay exact far from the origin. Invalid arrays are refused by
// instance, array and element, or their primitives are dropped and counted.
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/surface_layouts.hpp"

namespace rastrum::test::surface_arrays_test {

constexpr int kW = 90, kH = 70;

Camera camera_at(Vec3d origin) {
  return Camera{.eye = origin + Vec3d{0.5, -1, 7}, .target = origin};
}

Frame draw(Renderer& renderer, const GeometryView& geometry, Vec3d origin = {},
           FrameOptions frame = {}) {
  frame.width = kW;
  frame.height = kH;
  return test::draw(renderer, OneInstance(geometry).view(), camera_at(origin), frame,
                    kColor | kVisible);
}

TEST(SurfaceArrays, EveryLayoutHasThePictureOfThePackedOne) {
  const Cloud cloud(120);
  for (const RendererOptions& by :
       {RendererOptions{.threads = 2}, RendererOptions{.device = Device::serial}}) {
    Renderer renderer(by);
    for (const FrameOptions& frame :
         {FrameOptions{.shader = Shader::phong}, FrameOptions{.shader = Shader::flat, .samples = 4},
          FrameOptions{.shader = Shader::material, .opacity = 0.5F}}) {
      std::vector<Frame> packed;
      for (const GeometryView& g : CloudViews(cloud).geometries()) {
        packed.push_back(draw(renderer, g, {}, frame));
        ASSERT_GT(packed.back().stats.pixels_covered, 400U);
      }
      for (const CloudLayout& layout : cloud_layouts()) {
        Memory memory;
        const std::vector<GeometryView> other = layout.geometries(cloud, memory);
        for (std::size_t i = 0; i < (layout.wide ? kPointsAndLinesFrom : other.size()); ++i)
          EXPECT_TRUE(same_images(packed[i], draw(renderer, other[i], {}, frame)))
              << layout.name << ", geometry " << i;
      }
    }
  }
}

// A molecule at 10⁷ units with float64 positions; all that is derived from them is float64 too.
TEST(SurfaceArrays, AMoleculeFarFromTheOriginStandsStill) {
  const Cloud cloud(120);
  const Vec3d far{1e7, -2e7, 3e7};
  Renderer renderer;
  CloudViews views(cloud);
  const std::vector<GeometryView> at_origin = views.geometries();
  std::vector<Vec3d> wide;
  std::vector<Vec3> narrow;
  for (const Vec3& p : cloud.positions) {
    wide.push_back(Vec3d(p) + far);
    narrow.push_back(Vec3(wide.back()));
  }
  const auto ids_that_differ = [&](const ArrayView<Vec3>& positions) {
    views.positions = positions;
    const std::vector<GeometryView> there = views.geometries();
    std::size_t n = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      const Frame a = draw(renderer, at_origin[i]), b = draw(renderer, there[i], far);
      for (const auto& [x, y] : pixels(kW, kH)) n += a.ids(x, y) != b.ids(x, y) ? 1U : 0U;
    }
    return n;
  };
  EXPECT_EQ(ids_that_differ(wide), 0U);
  EXPECT_GT(ids_that_differ(narrow), 1000U);
}

template <class T>
std::span<const std::byte> bytes(const std::vector<T>& v) {
  return std::as_bytes(std::span(v));
}

/// The message about the second of two instances.
std::string message_of(const GeometryView& geometry) {
  return test::error_message_of([&] {
    const KeptInstances instances{SpheresView{}, geometry};
    (void)test::draw({.threads = 1}, {instances, {}, {}}, {}, {.width = kW, .height = kH}, kDepth);
  });
}

template <class C>
void refuse_index(C value, const std::string& text) {
  const std::vector<Vec3> positions(100);
  const std::vector<C> indices{0, 1, 2, value}, offsets{0, value};
  EXPECT_TRUE(
      holds(message_of(CylindersView{.positions = positions, .indices = indices}),
            "instance 1: indices[3]: index " + text + " is out of range, there are 100 positions"));
  const std::string said = message_of(TubesView{.positions = positions, .offsets = offsets});
  if (text == "100")
    EXPECT_EQ(said, "") << "an offset may be the number of positions";
  else
    EXPECT_TRUE(holds(said, "instance 1: offsets[1] is " + text));
}

TEST(SurfaceArrays, RefuseIndicesThatAreOutOfRange) {
  refuse_index<std::uint8_t>(200, "200");
  refuse_index<std::int8_t>(-1, "-1");
  refuse_index<std::uint16_t>(100, "100");
  refuse_index<std::int16_t>(-32768, "-32768");
  refuse_index<std::uint32_t>(0xFFFFFFFF, "4294967295");
  refuse_index<std::int32_t>(-1, "-1");
  refuse_index<std::uint64_t>(std::uint64_t{1} << 40, "1099511627776");
  refuse_index<std::uint64_t>(std::uint64_t{1} << 32, "4294967296");
  refuse_index<std::int64_t>(-1, "-1");
}

TEST(SurfaceArrays, RefuseOffsetsThatDoNotRise) {
  const std::vector<Vec3> positions(10);
  const auto message = [&](const std::vector<std::int64_t>& offsets) {
    return message_of(TubesView{.positions = positions, .offsets = offsets});
  };
  EXPECT_TRUE(holds(message({0, 5, 4}),
                    "instance 1: offsets[2] is 4, which does not lie above the one before, 5"));
  EXPECT_TRUE(holds(message({2, 2}), "offsets[1] is 2, which does not lie above"));
  EXPECT_TRUE(holds(message({-3, 4}), "offsets[0] is -3, but there are 10 positions"));
  EXPECT_TRUE(holds(message({0, 11}), "offsets[1] is 11, but there are 10 positions"));
  EXPECT_EQ(message({3, 4, 10}), "");
  const std::vector<std::uint16_t> good{3, 4, 10};
  EXPECT_EQ((TubesView{.positions = positions, .offsets = good}.size()), 5U);
}

TEST(SurfaceArrays, RefuseStridesBeyondTheirBuffer) {
  const std::vector<double> radii(10);
  using Layout = ArrayLayout;
  constexpr NumberType kType = NumberType::float64;
  EXPECT_EQ(ArrayView<float>::in(bytes(radii), {kType, 1, 4, 0, 24}).size(), 4U);
  for (const Layout& l : {Layout{kType, 1, 11, 0, 8}, Layout{kType, 1, 4, 16, 24},
                          Layout{kType, 1, 3, 8, -8}, Layout{kType, 1, 2, 80, 0}})
    expect_refused("reach beyond a buffer of 80 bytes",
                   [&] { (void)ArrayView<float>::in(bytes(radii), l); });
  expect_refused("values have 3 channels, not 1", [&] {
    (void)ArrayView<Vec3>::in(bytes(radii), {kType, 1, 3, 0, 24});
  });
  expect_refused("normalized integers of 8 or 16 bits", [&] {
    (void)ArrayView<float>::in(bytes(radii), {NumberType::int32, 1, 3, 0, 4});
  });
}

TEST(SurfaceArrays, DropAndCountWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Renderer renderer;
  const std::vector<double> radii{1, kNan, kInfinity, -1, -kInfinity, 0, 1e300, 1};
  const std::vector<Vec3d> places(radii.size());
  const ArrayView<float> wide = ArrayView<float>::of(radii.data(), radii.size());
  // 1e300 becomes infinite.
  const auto dropped = [&](const GeometryView& g) {
    return draw(renderer, g).stats.triangles.dropped;
  };
  EXPECT_EQ(dropped(SpheresView{.centers = places, .radii = wide}), 5U);
  const std::vector<Vec3d> odd{{kNan, 0, 0}, {0, kInfinity, 0}, {0, 0, -kInfinity}, {0, 0, 0}};
  EXPECT_EQ(dropped(SpheresView{.centers = odd}), 3U);
  EXPECT_EQ(dropped(CylindersView{.positions = odd}), 2U);
  EXPECT_EQ(dropped(TubesView{.positions = odd}), 3U);
  EXPECT_EQ(dropped(DiscsView{.centers = odd, .normals = odd}), 3U);
  EXPECT_EQ(draw(renderer, SpheresView{.centers = odd}).stats.triangles.drawn, 1U);
}

TEST(SurfaceArrays, ThatAreEmptyDrawNothing) {
  Renderer renderer;
  const std::vector<Vec3> one{{0, 0, 0}};
  const std::vector<std::int64_t> offset{0}, single{0, 1};
  for (const GeometryView& g :
       {GeometryView{SpheresView{}}, GeometryView{CylindersView{}}, GeometryView{TubesView{}},
        GeometryView{DiscsView{}}, GeometryView{TubesView{.positions = one}},
        GeometryView{TubesView{.positions = one, .offsets = offset}},
        GeometryView{TubesView{.positions = one, .offsets = single}}}) {
    const Frame p = draw(renderer, g);
    EXPECT_EQ(p.stats.pixels_covered, 0U);
    EXPECT_EQ(p.stats.triangles.input, 0U);
  }
}

// Geometries that a scene owns move with it, have a look beside materials, and are drawn like
// views.
TEST(SurfaceArrays, AreOwnedByScenesToo) {
  Scene scene = shapes::scene_from_spec("torus_knot");
  scene.materials.resize(1);
  for (const char* spec : {"spheres?count=40", "tube?segments=20", "cylinders?count=30", "discs"})
    scene.append(shapes::scene_from_spec(spec));
  Mat4d up = Mat4d::identity();
  up.m[1][3] = 2;
  scene.place(up);
  const SceneBinding binding(scene);
  const SceneView view = binding.view();
  ASSERT_EQ(view.instances.size(), 5U);
  KeptInstances same{*view.instances[0].mesh()};
  const auto& spheres = std::get<Spheres>(scene.geometries[0]);
  const auto& tubes = std::get<Tubes>(scene.geometries[1]);
  const auto& cylinders = std::get<Cylinders>(scene.geometries[2]);
  const auto& discs = std::get<Discs>(scene.geometries[3]);
  same.add(SpheresView{spheres.centers, spheres.radii, 1, spheres.colors, spheres.material});
  same.add(TubesView{tubes.positions, {}, {}, tubes.radius, tubes.colors, tubes.material});
  same.add(CylindersView{
      cylinders.positions, {}, cylinders.radii, 1, cylinders.colors, true, cylinders.material});
  same.add(DiscsView{discs.centers, discs.normals, discs.radii, 1, discs.colors, discs.material});
  for (std::size_t i = 0; i < 5; ++i) same[i].object_to_world = view.instances[i].object_to_world;
  // Their own colours show.
  EXPECT_LT(spheres.material, scene.materials.size());
  EXPECT_EQ(scene.materials[spheres.material].alpha_mode, AlphaMode::blend);
  const Bounds b = bounds(view);
  EXPECT_GT(b.min.y, 0.3F);
  EXPECT_LT(b.max.y, 3.7F);
  Renderer renderer;
  FrameOptions frame{.width = kW, .height = kH};
  const Camera camera = fit_camera(view, 0.8F, false);
  const Frame owned = test::draw(renderer, view, camera, frame, kColor | kIds);
  EXPECT_TRUE(same_images(owned, test::draw(renderer, {same, view.materials, view.textures}, camera,
                                            frame, kColor | kIds)));
  EXPECT_GT(owned.stats.pixels_covered, 1000U);
  EXPECT_EQ(owned.stats.triangles.input, scene.primitive_count());
}

}  // namespace rastrum::test::surface_arrays_test
