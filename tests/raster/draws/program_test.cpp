// SPDX-License-Identifier: BSD-3-Clause
// The programmable pipeline: interpolation against its definition in long double, the built-in
// phong as a caller's shader, discard.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"

namespace rastrum::test::program_test {
namespace {

constexpr int kWidth = 200, kHeight = 150;

RenderOptions options(Device device) {
  return RenderOptions({.width = kWidth, .height = kHeight, .background = {0, 0, 0, 0}},
                       {.device = device, .threads = 2});
}

struct Drawn {
  Image<Vec4> color{kWidth, kHeight};
  Image<std::int64_t> ids{kWidth, kHeight};
  FrameStats stats;
};
template <class Program>
Drawn draw_by(const RenderOptions& o, const Program& program, raster::Draw draw) {
  Drawn d;
  d.stats = Painter(o).draw({&draw, 1}, program, program, {.color = d.color, .ids = d.ids});
  return d;
}

/// A varying of several parts.
struct Mixed {
  Vec3 position;
  Vec3 normal;
  float scalar = 0;
  Mixed operator+(const Mixed& o) const {
    return {position + o.position, normal + o.normal, scalar + o.scalar};
  }
  Mixed operator*(float s) const { return {position * s, normal * s, scalar * s}; }
};

struct Corner {
  Vec4 clip;
  float value;
};

/// The interpolated value at the pixel's ray, by the conventions and without the library's planes:
/// in homogeneous clip space, or from snapped positions and 1/w.
long double exact_value(const Corner (&c)[3], int x, int y, bool clipped) {
  using L = long double;
  const raster::Viewport viewport = raster::Viewport::of(kWidth, kHeight);
  L b[3];
  if (clipped) {
    const L px = (x + 0.5L) / (kWidth / 2.0L) - 1, py = 1 - (y + 0.5L) / (kHeight / 2.0L);
    for (int i = 0; i < 3; ++i) {
      const Vec4 &p = c[(i + 1) % 3].clip, &q = c[(i + 2) % 3].clip;
      b[i] = px * (L{p.y} * q.w - L{p.w} * q.y) + py * (L{p.w} * q.x - L{p.x} * q.w) +
             (L{p.x} * q.y - L{p.y} * q.x);
    }
  } else {
    L sx[3], sy[3];
    for (int i = 0; i < 3; ++i) {
      const raster::ProjectedVertex v = raster::project(c[i].clip, viewport);
      sx[i] = v.x_fx8 / 256.0L;
      sy[i] = v.y_fx8 / 256.0L;
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      b[i] = ((sx[k] - sx[j]) * (y + 0.5L - sy[j]) - (sy[k] - sy[j]) * (x + 0.5L - sx[j])) /
             c[i].clip.w;
    }
  }
  return (b[0] * c[0].value + b[1] * c[1].value + b[2] * c[2].value) / (b[0] + b[1] + b[2]);
}

/// The same for a line, along its major axis: from the snapped ends and 1 / w, or from the
/// homogeneous ones.
long double exact_value(const Corner (&c)[2], int x, int y, bool clipped) {
  using L = long double;
  const auto between = [&](L u0, L u1, L u) {  // u: homogeneous coordinate over w at the sample
    const L b0 = u * c[1].clip.w - u1, b1 = u0 - u * c[0].clip.w;
    return (b0 * c[0].value + b1 * c[1].value) / (b0 + b1);
  };
  if (clipped) {
    const L dx = (L{c[0].clip.x} * c[1].clip.w - L{c[1].clip.x} * c[0].clip.w) * kWidth;
    const L dy = (L{c[0].clip.y} * c[1].clip.w - L{c[1].clip.y} * c[0].clip.w) * kHeight;
    if (std::abs(dx) >= std::abs(dy))
      return between(c[0].clip.x, c[1].clip.x, (x + 0.5L) / (kWidth / 2.0L) - 1);
    return between(c[0].clip.y, c[1].clip.y, 1 - (y + 0.5L) / (kHeight / 2.0L));
  }
  const raster::Viewport viewport = raster::Viewport::of(kWidth, kHeight);
  const raster::ProjectedVertex a = raster::project(c[0].clip, viewport);
  const raster::ProjectedVertex b = raster::project(c[1].clip, viewport);
  const L dx = (b.x_fx8 - a.x_fx8) / 256.0L, dy = (b.y_fx8 - a.y_fx8) / 256.0L;
  const L t = std::abs(dx) >= std::abs(dy) ? (x + 0.5L - a.x_fx8 / 256.0L) / dx
                                           : (y + 0.5L - a.y_fx8 / 256.0L) / dy;
  const L u = std::clamp(t, 0.0L, 1.0L), b0 = (1 - u) / c[0].clip.w, b1 = u / c[1].clip.w;
  return (b0 * c[0].value + b1 * c[1].value) / (b0 + b1);
}

/// Three corners make a triangle, two a line 3 px wide.
template <std::size_t N>
void expect_exact(const Corner (&corners)[N], bool clipped) {
  const Program program(
      [&](std::uint32_t i) {
        return VertexOutput<Mixed>{corners[i].clip, {{}, {}, corners[i].value}};
      },
      [](const Mixed& v, const Fragment&) {
        return Vec4{v.scalar, 0, 0, 1};
      });
  for (const Device device : {Device::serial, Device::threads}) {
    raster::Draw draw = program.draw(N, {}, N == 3 ? Topology::triangles : Topology::lines);
    draw.line_width = 3;
    const auto& [color, ids, stats] = draw_by(options(device), program, draw);
    EXPECT_EQ(stats.triangles.clipped, clipped ? 1U : 0U);
    EXPECT_GT(stats.pixels_covered, N == 3 ? 100U : 150U);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (color(x, y).w == 0) continue;
        const long double exact = exact_value(corners, x, y, clipped);
        ASSERT_NEAR(static_cast<double>(color(x, y).x / exact), 1, 1e-5) << x << ", " << y;
      }
  }
}

TEST(Program, VaryingsArePerspectiveCorrect) {
  // w from 0.1 to 4; z = 0.05 is the near plane's w.
  expect_exact(
      {{{-0.08F, -0.09F, 0.05F, 0.1F}, 1}, {{3.1F, -1, 0.05F, 4}, 2}, {{-0.5F, 1.7F, 0.05F, 2}, 5}},
      false);
  expect_exact(
      {{{-3, -2, 0.05F, 4}, 100}, {{0.1F, 0.05F, 0.05F, 0.15F}, 1}, {{-3.9F, 3, 0.05F, 4}, 3}},
      false);
}

TEST(Program, VaryingsOfNearClippedTrianglesToo) {
  // The second vertex is in front of the near plane (z > w), the third behind the eye.
  expect_exact(
      {{{-1.2F, -1, 0.1F, 2}, 1}, {{0.2F, -0.1F, 0.1F, 0.05F}, 2}, {{-0.3F, 1.7F, 0.1F, 2.5F}, 7}},
      true);
  expect_exact(
      {{{-1.9F, -1.5F, 0.1F, 2}, 3}, {{0.3F, 0.9F, 0.1F, -1}, 2}, {{1.9F, -1.2F, 0.1F, 2.5F}, 4}},
      true);
}

TEST(Program, VaryingsOfLinesArePerspectiveCorrect) {
  expect_exact({{{-0.09F, -0.03F, 0.05F, 0.1F}, 1}, {{3.5F, 1, 0.05F, 4}, 4}}, false);
  expect_exact({{{0.02F, 0.09F, 0.05F, 0.1F}, 7}, {{0.5F, -3.9F, 0.05F, 4}, 2}}, false);
  // Behind the near plane, behind the eye, beyond the guard band.
  expect_exact({{{-1.9F, -0.5F, 0.1F, 2}, 1}, {{0.01F, 0, 0.1F, 0.05F}, 5}}, true);
  expect_exact({{{0.1F, 1.5F, 0.1F, -1}, 9}, {{0.3F, -2, 0.1F, 2.5F}, 3}}, true);
  expect_exact({{{-1.5F, -1.7F, 0.1F, 2}, 1}, {{4000, 1000, 0.1F, 2}, 1000}}, true);
}

TEST(Program, APointHasItsVertexsVarying) {
  const Program program(
      [](std::uint32_t i) {
        return VertexOutput<Mixed>{{i == 0 ? -0.5F : 0.5F, 0, 0.5F, 1},
                                   {{}, {}, 0.1F + 0.3F * static_cast<float>(i)}};
      },
      [](const Mixed& v, const Fragment&) {
        return Vec4{v.scalar, 0, 0, 1};
      });
  raster::Draw draw = program.draw(2, {}, Topology::points);
  draw.point_size = 10;
  const auto& [color, ids, stats] = draw_by(options(Device::threads), program, draw);
  EXPECT_EQ(stats.pixels_covered, 200U);
  EXPECT_EQ(color(54, 79).x, 0.1F);
  EXPECT_EQ(color(154, 70).x, 0.1F + 0.3F);
}

TEST(Program, APointKnowsWhereInItsSquareItIs) {
  const Program program(
      [](std::uint32_t) {
        return VertexOutput<Mixed>{{0.25F, 0.5F, 0.5F, 1}, {}};
      },
      [](const Mixed&, const Fragment& f) {
        return Vec4{f.point.x, f.point.y, 0, 1};
      });
  raster::Draw draw = program.draw(1, {}, Topology::points);
  draw.point_size = 8;  // about (125, 37.5): columns 121 to 128, rows 34 to 41 from the top edge
  const auto& [color, ids, stats] = draw_by(options(Device::threads), program, draw);
  ASSERT_EQ(stats.pixels_covered, 64U);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_NEAR(color(121 + x, 33 + y).x, (static_cast<float>(x) + 0.5F) / 8, 1e-6F);
      EXPECT_NEAR(color(121 + x, 33 + y).y, static_cast<float>(y) / 8, 1e-6F);
    }
}

TEST(Program, SeveralTargetsGetWhatTheShaderReturns) {
  // Two triangles over each other; one shader has one output, the other three.
  const auto vertex = [](std::uint32_t i) {
    constexpr Vec4 kCorners[] = {{-0.8F, -0.8F, 0.5F, 1}, {0.9F, -0.7F, 0.5F, 1},
                                 {0, 0.9F, 0.5F, 1},      {-0.9F, 0.6F, 0.4F, 1},
                                 {-0.2F, -0.9F, 0.7F, 1}, {0.8F, 0.8F, 0.6F, 1}};
    return VertexOutput<Mixed>{kCorners[i], {{}, {}, 0.1F * static_cast<float>(i)}};
  };
  const auto color_of = [](const Mixed& v) { return Vec4{v.scalar, 0.5F * v.scalar, 0, 0.75F}; };
  const Program one(vertex, [&](const Mixed& v, const Fragment&) { return color_of(v); });
  const Program three(vertex, [&](const Mixed& v, const Fragment& f) {
    return std::array{
        color_of(v), Vec4{v.scalar, 2, f.depth, 3},
        Vec4{static_cast<float>(f.id), static_cast<float>(f.x), static_cast<float>(f.y), 1}};
  });
  EXPECT_EQ(raster::Shading(one).own()->extra_count(), 0U);
  ASSERT_EQ(raster::Shading(three).own()->extra_count(), 2U);
  for (const family::AxisInfo& visibility : family::visibility_axis()) {
    RenderOptions o = options(Device::threads);
    o.visibility = visibility.name;
    o.background = {0.1F, 0.2F, 0.3F, 0.5F};
    Painter renderer(o);
    Image<Rgba8> alone(kWidth, kHeight), with(kWidth, kHeight);
    Image<float> depth(kWidth, kHeight);
    Image<std::int64_t> ids(kWidth, kHeight);
    Image<Vec4> second(kWidth, kHeight), third(kWidth, kHeight);
    std::ranges::fill(second.pixels(), Vec4{-7, -7, -7, -7});
    std::ranges::fill(third.pixels(), Vec4{-7, -7, -7, -7});
    raster::Draw draw = one.draw(6);
    (void)renderer.draw({&draw, 1}, one, nullptr, {.color8 = alone});
    const std::array extra{second.view(), third.view()};
    Targets targets{.color8 = with, .depth = depth, .ids = ids, .extra = extra};
    draw = three.draw(6);
    (void)renderer.draw({&draw, 1}, three, nullptr, targets);
    EXPECT_TRUE(std::ranges::equal(alone.pixels(), with.pixels())) << visibility.name;
    int seen[3] = {};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const Vec4 a = second(x, y), b = third(x, y);
        ++seen[ids(x, y) + 1];
        if (ids(x, y) < 0) {
          ASSERT_TRUE(a.x == 0 && a.y == 0 && a.z == 0 && a.w == 0 && b.x == 0 && b.w == 0);
          continue;
        }
        ASSERT_EQ(a.y, 2);
        ASSERT_EQ(a.z, depth(x, y));
        ASSERT_EQ(b.x, static_cast<float>(ids(x, y)));
        ASSERT_EQ(b.y, static_cast<float>(x));
        ASSERT_EQ(b.z, static_cast<float>(y));
      }
    for (const int n : seen) EXPECT_GT(n, 1000) << visibility.name;

    // Refuses more targets than outputs, and targets of another size.
    draw = one.draw(6);
    EXPECT_THROW((void)renderer.draw({&draw, 1}, one, nullptr, targets), Error);
    Image<Vec4> small(8, 8);
    const std::array wrong{small.view()};
    targets.extra = wrong;
    draw = three.draw(6);
    EXPECT_THROW((void)renderer.draw({&draw, 1}, three, nullptr, targets), Error);
  }
}

TEST(Program, FrontIsWhatTheWindingSays) {
  // One counter-clockwise and one clockwise triangle, and both again with a corner behind the eye.
  const Vec4 corners[] = {{-0.9F, -0.9F, 0.5F, 1}, {-0.1F, -0.9F, 0.5F, 1}, {-0.5F, 0.9F, 0.5F, 1},
                          {0.1F, -0.9F, 0.5F, 1},  {0.5F, 0.9F, 0.5F, 1},   {0.9F, -0.9F, 0.5F, 1}};
  for (const bool clipped : {false, true}) {
    const Program program(
        [&](std::uint32_t i) {
          Vec4 c = corners[i];
          if (clipped && (i == 2 || i == 4)) c = {c.x, 20, 0.5F, -1};
          return VertexOutput<Mixed>{c, {}};
        },
        [](const Mixed&, const Fragment& f) {
          return Vec4{f.front ? 1.0F : 0.5F, 0, 0, 1};
        });
    for (const auto winding : {Winding::counter_clockwise, Winding::clockwise, Winding::either}) {
      raster::Draw draw = program.draw(6);
      draw.winding = winding;
      const auto& [color, ids, stats] = draw_by(options(Device::threads), program, draw);
      ASSERT_EQ(stats.triangles.clipped, clipped ? 2U : 0U);
      const bool swapped = winding == Winding::clockwise;
      EXPECT_EQ(color(kWidth / 4, kHeight * 3 / 4).x, swapped ? 0.5F : 1.0F) << clipped;
      EXPECT_EQ(color(kWidth * 3 / 4, kHeight * 3 / 4).x, swapped ? 1.0F : 0.5F) << clipped;
    }
  }
}

TEST(Program, APhongOfOnesOwnIsTheBuiltInOne) {
  const Mesh mesh = shapes::sphere(24, 48);
  ASSERT_FALSE(mesh.normals.empty());
  Scene scene;
  scene.meshes.push_back(mesh);
  scene.instances = {{0, Mat4d::identity()}};
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1.0F, false);
  const Mat4 to_clip(world_to_clip(camera, kWidth, kHeight));

  const Program program(
      [&](std::uint32_t i) {
        const Vec3 p = mesh.positions[i];
        return VertexOutput<Mixed>{transform_point(to_clip, p), {p, mesh.normals.values[i], 0}};
      },
      [&](const Mixed& m, const Fragment&) {
        const Vec3 v = normalize(Vec3(camera.eye) - m.position);
        Vec3 n = normalize(m.normal);
        if (dot(n, v) < 0) n = -n;
        const Vec3 l = normalize(Vec3{0.4F, 0.6F, 1});
        const float diffuse = 0.1F + 0.8F * std::max(dot(n, l), 0.0F);
        const float shine = 0.3F * std::pow(std::max(dot(n, normalize(v + l)), 0.0F), 32.0F);
        return Vec4{0.8F * diffuse + shine, 0.7F * diffuse + shine, 0.6F * diffuse + shine, 1};
      });
  EXPECT_FALSE(raster::Testing(program));
  for (const Device device : {Device::serial, Device::threads}) {
    RenderOptions o = options(device);
    o.shader = Shader::phong;
    Painter renderer(o);
    Frame callers(kWidth, kHeight, kColor8 | kIds);
    raster::Draw drawn = program.draw(mesh.positions.size(), mesh.indices);
    (void)renderer.draw({&drawn, 1}, program, program, callers.targets());
    const Frame built_in = draw(renderer, binding.view(), camera, kColor8 | kIds);
    ASSERT_GT(built_in.stats.pixels_covered, 5000U);
    EXPECT_TRUE(same_images(callers, built_in, kIds));
    EXPECT_TRUE(same_picture(callers, built_in, 1));
    EXPECT_TRUE(pixels_are(
        callers.color8, [&](int x, int y) { return built_in.color8(x, y).a; },
        [](Rgba8 c, std::uint8_t alpha) { return c.a == alpha; }));
  }
}

TEST(Program, DiscardedFragmentsAreHoles) {
  // A quad whose varying is its pixel position, over a farther quad of the same program.
  const auto vertex = [](std::uint32_t i) {
    const bool behind = i >= 6;
    constexpr int kCorner[6] = {0, 1, 2, 0, 2, 3};
    const int corner = kCorner[i % 6];
    const bool right = corner == 1 || corner == 2, top = corner >= 2;
    const Vec4 clip{right ? 1.0F : -1.0F, top ? 1.0F : -1.0F, behind ? 0.25F : 0.5F, 1};
    const Vec3 px{right ? float{kWidth} : 0.0F, top ? 0.0F : float{kHeight}, 0};
    return VertexOutput<Mixed>{clip, {px, {}, behind ? 1.0F : 0.0F}};
  };
  const auto is_hole = [](int x, int y) { return (x / 3 + y / 5) % 2 == 0; };
  const Program program(
      vertex,
      [](const Mixed& v, const Fragment& f) {
        return Vec4{v.scalar, f.depth, 0, 0.5F};
      },
      [&](const Mixed& v, const Fragment& f) {
        EXPECT_EQ(f.depth, v.scalar > 0.5F ? 0.25F : 0.5F);
        EXPECT_NEAR(v.position.x, static_cast<float>(f.x) + 0.5F, 1e-3F);
        return v.scalar < 0.5F && is_hole(f.x, f.y);
      });
  ASSERT_TRUE(raster::Testing(program));
  for (const Device device : {Device::serial, Device::threads}) {
    const auto& [color, ids, stats] = draw_by(options(device), program, program.draw(12));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(ids(x, y) >= 2, is_hole(x, y)) << x << ", " << y;
        ASSERT_NEAR(color(x, y).x, is_hole(x, y) ? 1 : 0, 1e-6);
        ASSERT_EQ(color(x, y).y, is_hole(x, y) ? 0.25F : 0.5F);
        ASSERT_EQ(color(x, y).w, 0.5F);
      }
  }
}

}  // namespace
}  // namespace rastrum::test::program_test
