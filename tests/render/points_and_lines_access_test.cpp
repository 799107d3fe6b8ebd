// SPDX-License-Identifier: BSD-3-Clause
// Points and lines in the surface images, picking, fits, and refusals.
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/render.hpp>

#include "tests/support/picked.hpp"
#include "tests/support/point_line_scenes.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::points_and_lines_access_test {
namespace {

constexpr int kWidth = 90, kHeight = 60;

FrameOptions frame() {
  return FrameOptions{.width = kWidth, .height = kHeight, .shader = Shader::flat};
}

/// Every image agrees with `pick`, in all ways to draw.
TEST(PointsAndLinesAccess, PickIsWhatTheImagesHold) {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const PointLineScene s = generate_points_and_lines(seed, kWidth, kHeight);
    Renderer serial({.device = Device::serial}), threads({.threads = 2});
    const Frame fast = draw(threads, s.view(), s.camera, frame(), kSurfaces);
    ASSERT_TRUE(same_images(fast, draw(serial, s.view(), s.camera, frame(), kSurfaces)));
    for (int y = 1; y < kHeight; y += 7)
      for (int x = 1; x < kWidth; x += 7) {
        const std::optional<Pick> p = threads.pick(s.view(), s.camera, frame(), x, y);
        ASSERT_EQ(p.has_value(), fast.ids(x, y) >= 0);
        if (!p) continue;
        ++seen;
        ASSERT_NO_FATAL_FAILURE(expect_picked(*p, fast, x, y));
        const Located at{p->instance, p->primitive};
        ASSERT_TRUE(
            same_pixel(Vec3(position(s.view(), at, p->barycentrics)), fast.positions(x, y)));
      }
  }
  EXPECT_GT(seen, 300);
}

TEST(PointsAndLinesAccess, ImagesHoldTheSurface) {
  const std::vector<Vec3> ends{{-1, 0, 0}, {1, 0, 0}}, dot{{0, 0.5F, 0}}, normal{{0, 0, -2}};
  const std::vector<Vec4> colors{{1, 0, 0, 1}, {0, 0, 1, 0.5F}};
  LinesView line{.positions = ends, .colors = colors, .line_width = 7};
  PointsView point{.positions = dot, .normals = normal, .point_size = 5};
  InstanceView instances[2] = {{line}, {point}};
  instances[0].object_to_world.m[2][3] = -0.25;
  instances[1].id = 77;
  Camera camera{.eye = {0, 0, 2}, .target = {0, 0, 0}, .orthographic = true};
  camera.orthographic_height = 3;  // 20 px a unit
  camera.near_plane = 0.5F;
  camera.far_plane = 5;
  const Frame s = draw({.threads = 1}, {instances, {}, {}}, camera, frame(), kSurfaces);
  const int x = 50, y = 30, py = 20;  // the line's at x = 0.275; the point is at (45, 20)
  EXPECT_EQ(s.instances(x, y), 0);
  EXPECT_EQ(s.primitives(x, y), 0);
  const float b = (0.275F + 1) / 2;
  EXPECT_NEAR(s.barycentrics(x, y).x, b, 1e-6F);
  EXPECT_EQ(s.barycentrics(x, y).y, 0);
  EXPECT_NEAR(s.positions(x, y).x, 0.275F, 1e-6F);
  EXPECT_EQ(s.positions(x, y).z, -0.25F);
  EXPECT_TRUE(same_pixel(s.normals(x, y), Vec3{}));
  EXPECT_NEAR(s.view_depth(x, y), 2.25F, 1e-5F);
  EXPECT_NEAR(s.albedo(x, y).x, 1 - b, 1e-6F);
  EXPECT_NEAR(s.albedo(x, y).w, 1 - b / 2, 1e-6F);
  EXPECT_EQ(s.instances(45, py), 77);
  EXPECT_TRUE(same_pixel(s.barycentrics(45, py), Vec2{}));
  EXPECT_TRUE(same_pixel(s.positions(46, py + 1), dot[0]));
  EXPECT_EQ(s.normals(45, py), (Vec3{0, 0, 1})) << "turned to the viewer";
  EXPECT_TRUE(same_pixel(s.albedo(45, py), plain_material(false).base_color));
  EXPECT_EQ(s.ids(5, 5), -1);
  EXPECT_EQ(s.instances(5, 5), -1);
}

TEST(PointsAndLinesAccess, FitsSeeAllOfThem) {
  const std::vector<Vec3> at{{-3, 1, 0}, {5, 2, 1}, {100, 100, 100}};
  const std::vector<std::uint8_t> used{0, 1};
  PointsView points{.positions = at, .indices = used};
  LinesView line{.positions = at, .indices = used};
  for (const GeometryView& geometry : {GeometryView(points), GeometryView(line)}) {
    const OneInstance instance(geometry);
    const Bounds b = bounds(instance.view());
    EXPECT_EQ(b.vertices_in_use, 2U);
    EXPECT_TRUE(same_pixel(b.min, Vec3d{-3, 1, 0}));
    EXPECT_TRUE(same_pixel(b.max, Vec3d{5, 2, 1}));
    const Camera camera = fit_picture(instance.view(), {}, kWidth, kHeight);
    const FrameStats::Triangles drawn =
        draw({.threads = 1}, instance.view(), camera, frame(), kSurfaces).stats.triangles;
    EXPECT_EQ(drawn.drawn, drawn.input);
  }
  const std::vector<std::uint8_t> beyond{0, 3};
  points.indices = beyond;
  expect_refused("indices[1]: index 3 is out of range, there are 3 positions",
                 [&] { (void)bounds(OneInstance(points).view()); });
}

TEST(PointsAndLinesAccess, RefuseArraysThatAreWrong) {
  const std::vector<Vec3> at(4);
  const std::vector<Vec4> few(3);
  const std::vector<Vec3> one(1);
  const auto refuses = [&](const GeometryView& geometry, const char* part,
                           Errc code = Errc::invalid_argument) {
    const InstanceView instances[2] = {{}, {geometry}};
    const std::vector<Material> materials(2);
    Image<Vec4> color(kWidth, kHeight);
    for (const Device device : {Device::serial, Device::threads})
      expect_refused(part, code, [&] {
        Renderer({.device = device})
            .render({instances, materials, {}}, {}, frame(), {.color = color});
      });
  };
  const auto points = [&](auto change) {
    PointsView p{.positions = at};
    change(p);
    return p;
  };
  const auto lines = [&](auto change) {
    LinesView l{.positions = at};
    change(l);
    return l;
  };
  const std::vector<float> sizes(2);
  refuses(points([&](auto& p) { p.colors = few; }),
          "instance 1: colors are fewer (3) than positions (4)");
  refuses(points([&](auto& p) { p.normals = one; }), "normals are fewer (1)");
  refuses(points([&](auto& p) { p.sizes = sizes; }), "sizes are fewer (2)");
  refuses(points([](auto& p) { p.material = 2; }), "instance 1: material 2 is out of range");
  for (const float bad : {0.0F, -1.0F, 4097.0F, std::numeric_limits<float>::quiet_NaN()}) {
    refuses(points([&](auto& p) { p.point_size = bad; }), "instance 1: the point size must be");
    refuses(lines([&](auto& l) { l.line_width = bad; }), "instance 1: the line width must be");
  }
  refuses(lines([&](auto& l) { l.colors = few; }), "instance 1: colors are fewer");
  refuses(lines([](auto& l) { l.kind = static_cast<LineKind>(9); }), "kind is 9");
  const std::vector<std::int32_t> odd{0, 1, 2}, offsets{0, 2, 2, 4}, beyond{0, 5}, negative{-1, 2};
  refuses(lines([&](auto& l) { l.indices = odd; }), "the number of corners, 3, is odd");
  refuses(lines([&](auto& l) { l.offsets = offsets; }), "segments have no offsets");
  for (const auto* const bad : {&offsets, &beyond, &negative})
    refuses(lines([&](auto& l) {
              l.kind = LineKind::polylines;
              l.offsets = *bad;
            }),
            "instance 1: offsets: polyline");
  const auto index_of = [&](auto type, const char* text) {
    const std::vector<decltype(type)> indices{1, 0, type, 2};
    const std::string part = "instance 1: indices[2]: index " + std::string(text) +
                             " is out of range, there are 4 vertices";
    refuses(points([&](auto& p) { p.indices = indices; }), part.c_str());
    refuses(points([&](auto& p) {
              p.indices = indices;
              p.point_size = 9;
            }),
            part.c_str());
    refuses(lines([&](auto& l) { l.indices = indices; }), part.c_str());
  };
  index_of(std::uint8_t{4}, "4");
  index_of(std::int8_t{-1}, "-1");
  index_of(std::uint16_t{65535}, "65535");
  index_of(std::int32_t{-7}, "-7");
  index_of(std::uint32_t{4'000'000'000}, "4000000000");
  index_of(std::int64_t{1} << 40, "1099511627776");
  index_of(~std::uint64_t{0}, "18446744073709551615");
  const std::vector<std::byte> buffer(48);
  EXPECT_THROW((void)ArrayView<Vec3>::in(buffer, {.channels = 3, .count = 4, .stride_bytes = 16}),
               Error);
}

}  // namespace
}  // namespace rastrum::test::points_and_lines_access_test
