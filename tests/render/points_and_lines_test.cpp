// SPDX-License-Identifier: BSD-3-Clause
// Points and lines of a scene: the visible ones are the brute-force oracle's, every way to draw
// them gives the same bits, and colours, normals and materials apply.
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/family.hpp"
#include "tests/support/point_line_scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::points_and_lines_test {
namespace {

constexpr int kWidth = 150, kHeight = 91;  // several bins, cut at the edges

FrameOptions frame_of(Shader shader = Shader::flat) {
  return FrameOptions{.width = kWidth, .height = kHeight, .shader = shader};
}

Frame draw(Renderer& renderer, const SceneView& scene, const Camera& camera,
           const FrameOptions& o) {
  return test::draw(renderer, scene, camera, o, kColor | kVisible | kOverdraw);
}

TEST(PointsAndLines, AreWhatTheOracleSays) {
  Renderer serial({.device = Device::serial}), threads({.threads = 2});
  std::uint64_t points = 0, discs = 0, segments = 0, dropped = 0;
  for (int seed = 0; seed < share_of(400, 12); ++seed) {
    SCOPED_TRACE(seed);
    const PointLineScene s =
        generate_points_and_lines(static_cast<std::uint64_t>(seed), kWidth, kHeight);
    const OracleImage want = brute_force(kWidth, kHeight, s.primitives);
    Frame p;
    for (Renderer* const renderer : {&serial, &threads}) {
      p = draw(*renderer, s.view(), s.camera, frame_of());
      ASSERT_TRUE(same_surfaces(p, want));
      ASSERT_EQ(p.stats.triangles.input, s.input);
      ASSERT_EQ(p.stats.triangles.dropped, s.dropped);
    }
    dropped += s.dropped;
    for (const SnappedPrimitive& primitive : s.primitives) {
      const std::uint64_t seen = want.pixels_of(primitive);
      if (const auto* const point = std::get_if<SnappedPoint>(&primitive.shape))
        (point->round ? discs : points) += seen;
      segments += std::holds_alternative<SnappedLine>(primitive.shape) ? seen : 0;
    }
  }
  const auto enough = static_cast<std::uint64_t>(share_of(10000));
  EXPECT_GT(points, enough);
  EXPECT_GT(discs, enough);
  EXPECT_GT(segments, enough);
  EXPECT_GT(dropped, enough / 100);
}

/// Instruction sets, threads, limits of memory; opaque, in layers, with several samples.
TEST(PointsAndLines, AreTheSameBitsEverywhere) {
  for (const bool layers : {false, true}) {
    EveryWay ways{{.threads = 1}, {.memory_limit = std::uint64_t{8} << 20, .threads = 3}};
    for (int seed = 0; seed < share_of(120, 12); ++seed) {
      PointLineScene s =
          generate_points_and_lines(static_cast<std::uint64_t>(seed), kWidth, kHeight);
      Random r(static_cast<std::uint64_t>(seed));
      constexpr Shader kShaders[] = {Shader::flat,    Shader::normal, Shader::id,
                                     Shader::lambert, Shader::phong,  Shader::wireframe};
      FrameOptions o = frame_of(kShaders[seed % 6]);
      if (layers) {
        if (seed % 3 != 0) o.samples = 4;
        for (InstanceView& i : s.instances)
          if (r.chance(0.6)) i.opacity = r.real32(0.2, 1);
      }
      SCOPED_TRACE(testing::Message() << "scene " << seed << ", layers " << layers);
      ways.same([&](Renderer& renderer) { return draw(renderer, s.view(), s.camera, o); },
                [](const Frame& got, const Frame& expected) {
                  EXPECT_TRUE(same_triangles(got.stats, expected.stats));
                });
    }
  }
}

/// The kernels of all instruction sets make the fragments of the scalar one, in its order.
TEST(PointsAndLines, KernelsMakeTheSameFragments) {
  using namespace raster;
  Random r(7);
  std::uint64_t fragments = 0, slow = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<ProjectedVertex> vertices(static_cast<std::size_t>(r.integer(1, 256)));
    for (ProjectedVertex& v : vertices) {
      v.x_fx8 = r.chance(0.05) ? kNeedsClip : r.integer(-600, 600 * 256);
      v.y_fx8 = r.integer(-600, 300 * 256);
      v.depth = r.chance(0.1) ? -0.0F : r.real32(-0.2, 1.2);
    }
    std::vector<std::int32_t> sizes(vertices.size());
    for (std::int32_t& size : sizes) size = r.integer(256, 800);
    PointsInput in{.vertices = vertices.data(),
                   .count = static_cast<std::uint32_t>(vertices.size()),
                   .sizes = round % 2 == 0 ? nullptr : sizes.data(),
                   .first_id = 1'000'000'007,
                   .flags = (round % 4 < 2 ? kRound : 0) | (round % 8 < 4 ? kTranslucent : 0),
                   .view = {0, 0, 577, 251},
                   .bin_columns = 10};
    const auto made = [&](Isa isa) {
      std::vector<BinFragment> out(kSetupBatch * 16);
      std::vector<std::uint32_t> left(kSetupBatch);
      const SetupOutput n = kernels(isa).points(in, out.data(), left.data());
      out.resize(n.fragments);
      left.resize(n.slow);
      return std::tuple(out, left, n.micro);
    };
    const auto [want, want_slow, want_micro] = made(Isa::scalar);
    fragments += want.size();
    slow += want_slow.size();
    for (const Isa isa : available_isas()) {
      const auto [got, got_slow, got_micro] = made(isa);
      ASSERT_EQ(got.size(), want.size()) << name(isa);
      ASSERT_EQ(std::memcmp(got.data(), want.data(), got.size() * sizeof(BinFragment)), 0)
          << name(isa);
      ASSERT_EQ(got_slow, want_slow);
      ASSERT_EQ(got_micro, want_micro);
    }
  }
  EXPECT_GT(fragments, 100'000U);
  EXPECT_GT(slow, 1000U);
}

/// A scene of one instance, seen from +z at 50 px a unit.
struct Flat {
  std::vector<InstanceView> instances;
  std::vector<Material> materials;

  explicit Flat(GeometryRef geometry) : instances{InstanceView{geometry}} {}
  [[nodiscard]] Frame draw(const FrameOptions& o = frame_of()) const {
    Renderer renderer({.threads = 1});
    return points_and_lines_test::draw(renderer, {instances, materials, {}},
                                       {.eye = {0, 0, 5},
                                        .target = {0, 0, 0},
                                        .orthographic = true,
                                        .orthographic_height = kHeight / 50.0F,
                                        .far_plane = 10},
                                       o);
  }
};
const Vec4 kRed{1, 0, 0, 1}, kBlue{0, 0, 1, 1};

void expect_near(Vec4 a, Vec4 b, float by = 1e-5F) {
  for (const float d : {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}) EXPECT_NEAR(d, 0, by);
}

/// The colour in the middle of the picture.
Vec4 middle(const Frame& p) {
  return p.color(kWidth / 2, kHeight / 2);
}

TEST(PointsAndLines, ShowTheirColours) {
  const std::vector<Vec3> at{{-1, 0, 0}, {1, 0, 0}};
  const std::vector<Vec4> colors{kRed, kBlue};
  LinesView line{.positions = at, .colors = colors, .line_width = 5};
  const Frame p = Flat(line).draw();
  expect_near(middle(p), {0.5F, 0, 0.5F, 1}, 0.01F);
  expect_near(p.color(kWidth / 2 - 49, kHeight / 2), kRed, 0.02F);
  // Without normals lit shaders show plain colours too.
  EXPECT_TRUE(same_images(Flat(line).draw(frame_of(Shader::phong)), p, kColor));
  EXPECT_TRUE(same_images(Flat(line).draw(frame_of(Shader::normal)), p, kColor));
  // An instance's colour replaces theirs; without one they have the plain one.
  Flat painted(line);
  painted.instances[0].color = kBlue;
  expect_near(middle(painted.draw()), kBlue);
  line.colors = {};
  expect_near(middle(Flat(line).draw(frame_of(Shader::lambert))), {0.8F, 0.7F, 0.6F, 1});
}

TEST(PointsAndLines, AreLitByTheNormalsOfPoints) {
  const std::vector<Vec3> at{{0, 0, 0}}, to_side{{0, 3, 0}}, none{{0, 0, 0}};
  PointsView point{.positions = at, .point_size = 9};
  const Vec4 plain = middle(Flat(point).draw(frame_of(Shader::phong)));
  expect_near(plain, {0.8F, 0.7F, 0.6F, 1});
  point.normals = to_side;
  expect_near(middle(Flat(point).draw(frame_of(Shader::normal))), {0.5F, 1, 0.5F, 1});
  const Vec4 lit = middle(Flat(point).draw(frame_of(Shader::lambert)));
  // 0.1 + 0.8 n · l, l = (0.4, 0.6, 1) normalized.
  const float share = 0.1F + 0.8F * 0.6F / std::sqrt(0.16F + 0.36F + 1);
  expect_near(lit, {0.8F * share, 0.7F * share, 0.6F * share, 1});
  // A zero normal means no lighting.
  point.normals = none;
  expect_near(middle(Flat(point).draw(frame_of(Shader::phong))), plain);
}

TEST(PointsAndLines, HeedMaterials) {
  const std::vector<Vec3> at{{-1, 0, 0}, {1, 0, 0}};
  const std::vector<Vec4> fading{{1, 1, 1, 0}, {1, 1, 1, 1}};
  LinesView line{.positions = at, .colors = fading, .line_width = 5, .material = 1};
  Flat s(line);
  s.materials.resize(2);
  s.materials[1].base_color = {0.5F, 0.25F, 1, 1};
  // Converted to sRGB.
  expect_near(middle(s.draw(frame_of(Shader::material))), {0.735357F, 0.537099F, 1, 1}, 1e-4F);
  const auto left = [](const Frame& p) { return p.color(kWidth / 2 - 25, kHeight / 2); };
  s.materials[1].alpha_mode = AlphaMode::blend;
  EXPECT_NEAR(left(s.draw()).w, 0.25F, 0.02F);
  s.materials[1].opacity = 0.5F;
  EXPECT_NEAR(left(s.draw()).w, 0.125F, 0.02F);
  s.materials[1].opacity = 1;
  s.materials[1].alpha_mode = AlphaMode::mask;
  s.materials[1].alpha_cutoff = 0.5F;
  const Frame masked = s.draw();
  EXPECT_EQ(masked.ids(kWidth / 2 - 25, kHeight / 2), -1);
  EXPECT_EQ(masked.ids(kWidth / 2 + 25, kHeight / 2), 0);
  // The same for points, each as a whole.
  PointsView points{.positions = at, .colors = fading, .point_size = 5, .material = 1};
  s.instances[0].geometry = points;
  const Frame dots = s.draw();
  EXPECT_EQ(dots.ids(kWidth / 2 - 50, kHeight / 2), -1);
  EXPECT_EQ(dots.ids(kWidth / 2 + 50, kHeight / 2), 1);
}

/// Two translucent points over each other and over a triangle, compared with colours blended by
/// hand.
TEST(PointsAndLines, BlendInLayers) {
  const std::vector<Vec3> near_far{{0.01F, 0, 1}, {0.01F, 0, 0.5F}};
  const std::vector<Vec4> colors{{1, 0, 0, 0.5F}, {0, 1, 0, 0.25F}};
  const std::vector<Vec3> triangle{{-3, -3, 0}, {3, -3, 0}, {0, 3, 0}};
  PointsView points{.positions = near_far, .colors = colors, .point_size = 7};
  Flat s(points);
  MeshView mesh{.positions = triangle};
  InstanceView behind{mesh};
  behind.color = kBlue;
  s.instances.push_back(behind);
  expect_near(middle(s.draw()), {0.5F, 0.125F, 0.375F, 1});
  // One pixel, so they are drawn as fragments.
  points.point_size = 1;
  s.instances[0].geometry = points;
  expect_near(middle(s.draw()), {0.5F, 0.125F, 0.375F, 1});
}

TEST(PointsAndLines, AreCutByPlanes) {
  const std::vector<Vec3> at{{-1, 0, 0}, {1, 0, 0}};
  LinesView line{.positions = at, .line_width = 3};
  Flat s(line);
  const std::vector<ClipPlane> keep_right{{{1, 0, 0}, -0.2}};
  s.instances[0].clip_planes = keep_right;
  const Frame p = s.draw();
  const int y = kHeight / 2, cut = kWidth / 2 + 10;  // x = 0.2 is at 85 px
  EXPECT_EQ(p.ids(cut - 1, y), -1);
  EXPECT_EQ(p.ids(cut + 1, y), 0);
  PointsView points{.positions = at, .point_size = 30};
  s.instances[0].geometry = points;
  const Frame q = s.draw();
  EXPECT_EQ(q.ids(kWidth / 2 - 50, y), -1);
  EXPECT_EQ(q.ids(kWidth / 2 + 50 - 14, y), 1) << "a point is there or not";
  EXPECT_EQ(q.stats.triangles.culled, 1U);
}

}  // namespace
}  // namespace rastrum::test::points_and_lines_test
