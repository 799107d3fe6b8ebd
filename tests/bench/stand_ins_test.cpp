// SPDX-License-Identifier: BSD-3-Clause
// The stand-ins for the papers' models, and the scenes that the papers describe in words.
#include <bench/contest.hpp>
#include <bench/peers/compare.hpp>
#include <bench/stand_ins.hpp>
#include <papers/paper1/published.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::bench::stand_ins_test {
namespace {

/// The number of directed edges without their opposite.
std::size_t open_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = mesh.indices[i + e], b = mesh.indices[i + (e + 1) % 3];
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  return static_cast<std::size_t>(
      std::ranges::count_if(edges, [](const auto& e) { return e.second > 0; }));
}

TEST(StandIns, BallsHaveExactlyTheAskedNumberAndAreClosed) {
  for (const Model& model : paper1::kModels)
    EXPECT_EQ(ball(model.triangles).triangle_count(), model.triangles) << model.name;
  for (const std::size_t n : {8U, 9U, 10U, 101U, 1144U, 4968U}) {
    const Mesh mesh = ball(n);
    EXPECT_EQ(mesh.triangle_count(), n);
    EXPECT_EQ(open_edges(mesh), n % 2 == 0 ? 0U : 3U) << n;
  }
  EXPECT_EQ(ball(1001, 0.75F, 3).triangle_count(), 1001U);
  EXPECT_THROW(static_cast<void>(ball(7)), Error);
  EXPECT_THROW(static_cast<void>(ball(20, 1, 3)), Error);
}

TEST(StandIns, MeshesAreBroughtToANumberOfTriangles) {
  const Mesh knot = shapes::torus_knot();
  for (const std::size_t n : {500U, 1144U, 12288U, 20001U, 40000U}) {
    const Mesh mesh = with_triangles(knot, n);
    ASSERT_EQ(mesh.triangle_count(), n);
    EXPECT_LT(*std::ranges::max_element(mesh.indices), mesh.positions.size());
  }
  EXPECT_EQ(with_triangles(knot, knot.triangle_count()).indices, knot.indices);
  EXPECT_EQ(with_triangles(shapes::soup(100), 100).triangle_count(), 100U) << "without indices";
  EXPECT_THROW(static_cast<void>(with_triangles(Mesh{}, 100)), Error);
}

TEST(StandIns, PartsAreTheSubdividedMesh) {
  const Mesh base = ball(101);
  const Mesh whole = shapes::subdivide(base, 2);
  std::size_t t = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    const Mesh part = subdivided_part(base, 2, k, 7);
    for (const std::uint32_t i : part.indices) {
      const Vec3 a = part.positions[i], b = whole.positions[whole.indices[t++]];
      ASSERT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z) << "corner " << t - 1;
    }
  }
  EXPECT_EQ(t, whole.indices.size());
}

TEST(StandIns, PassesOverPartsAreTheWholePicture) {
  const Mesh base = ball(301);
  const Mesh whole = shapes::subdivide(base, 1);
  Image<std::uint64_t> keys(90, 70), passes(90, 70);
  Image<Rgba8> color(90, 70), passes_color(90, 70);
  const auto pass = [&](const Mesh& mesh, Image<std::uint64_t>& to, Image<Rgba8>& to_color,
                        std::uint64_t first_id) {
    const Targets targets{.color8 = to_color.view(), .keys = to.view()};
    Renderer renderer({.threads = 2});
    draw(renderer, {mesh.view(), whole_view(base), 90, 70, &triangle_colors()}, {}, targets,
         {.load = first_id > 0, .first_id = first_id});
  };
  pass(whole, keys, color, 0);
  std::uint64_t first_id = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const Mesh part = subdivided_part(base, 1, k, 5);
    pass(part, passes, passes_color, first_id);
    first_id += part.triangle_count();
  }
  EXPECT_TRUE(std::ranges::equal(keys.pixels(), passes.pixels()));
  EXPECT_TRUE(std::ranges::equal(color.pixels(), passes_color.pixels()));
}

TEST(StandIns, TheCameraGivesTheAskedNumberOfFragments) {
  const Mesh mesh = ball(2000, 108.0F / 88, 1);
  const FragmentMatch match = match_fragments(mesh, 540, 440, 14207 * 25, 1);
  EXPECT_NEAR(static_cast<double>(match.found), 14207 * 25, 14207 * 25 * 0.01);
  Entrant all;
  all.options.threads = 1;
  all.options.hierarchical_z = false;
  EXPECT_EQ(fingerprint({mesh.view(), match.camera, 540, 440}, all).stats.fragments, match.found);
}

TEST(StandIns, LargeTrianglesHaveTheirSize) {
  constexpr int kWidth = 640, kHeight = 360;
  const Mesh mesh = sized_triangles(kWidth, kHeight, 50, 400, 4000, 3);
  ASSERT_EQ(mesh.triangle_count(), 50U);
  for (std::size_t t = 0; t < 50; ++t) {
    const Vec3 a = mesh.positions[3 * t], b = mesh.positions[3 * t + 1],
               c = mesh.positions[3 * t + 2];
    const float area = std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
    EXPECT_GE(area, 399);
    EXPECT_LE(area, 4001);
    for (const Vec3 p : {a, b, c}) {
      EXPECT_TRUE(p.x >= -0.01F && p.x <= kWidth + 0.01F) << p.x;
      EXPECT_TRUE(p.y >= -0.01F && p.y <= kHeight + 0.01F) << p.y;
    }
  }
}

TEST(StandIns, SheetsFillThePictureOncePerLayer) {
  constexpr int kWidth = 70, kHeight = 50, kLayers = 5, kCells = 4;
  constexpr std::int64_t kASheet = 2 * kCells * kCells;
  for (const Order order : {Order::front_to_back, Order::random, Order::back_to_front}) {
    const Mesh mesh = sheets(kWidth, kHeight, kLayers, kCells, order);
    EXPECT_EQ(mesh.triangle_count(), static_cast<std::size_t>(kLayers * kASheet));
    Image<std::uint32_t> overdraw(kWidth, kHeight);
    Image<std::int64_t> ids(kWidth, kHeight);
    Targets targets{.ids = ids.view(), .overdraw = overdraw.view()};
    Renderer renderer = family::make_renderer({.threads = 1}, {.hierarchical_z = false});
    draw(renderer, {mesh.view(), window_camera(kWidth, kHeight), kWidth, kHeight}, {}, targets);
    EXPECT_TRUE(std::ranges::all_of(overdraw.pixels(), [](std::uint32_t n) {
      return n == kLayers;
    })) << name(order);
    const auto [low, high] = std::ranges::minmax(ids.pixels());
    if (order == Order::front_to_back) {
      EXPECT_LT(high, kASheet);
    }
    if (order == Order::back_to_front) {
      EXPECT_GE(low, (kLayers - 1) * kASheet);
    }
  }
}

TEST(Contest, TimesWhatIsRightAndSaysWhyNot) {
  const Mesh mesh = ball(500);
  const Subject subject{mesh.view(), whole_view(mesh), 64, 64, &triangle_colors()};
  family::Options options;
  options.threads = 1;
  std::vector<Entrant> entrants(4, {"", options});
  entrants[0].name = "auto";
  entrants[1].options.rasterizer = "no-such-rasterizer";
  entrants[2].options.cull = Cull::front;  // shows the back: another picture
  entrants[3].options.memory_limit = 1;
  const std::vector<Result> results = contest(subject, entrants, {2, 0.5});
  ASSERT_EQ(results.size(), 4U);
  EXPECT_TRUE(results[0].ran());
  EXPECT_EQ(results[0].timing.samples_ms.size(), 2U);
  EXPECT_GT(results[0].stats.fragments, 0U);
  EXPECT_FALSE(results[0].stages_ms.empty());
  EXPECT_EQ(results[1].not_run, "absent");
  EXPECT_TRUE(results[2].wrong);
  EXPECT_EQ(results[2].not_run, "WRONG PICTURE");
  EXPECT_TRUE(results[2].timing.samples_ms.empty()) << "what is wrong is not timed";
  EXPECT_FALSE(results[3].ran());
  EXPECT_NE(results[3].not_run.find("memory"), std::string::npos) << results[3].not_run;
}

}  // namespace
}  // namespace rastrum::bench::stand_ins_test
