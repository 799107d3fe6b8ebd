// SPDX-License-Identifier: BSD-3-Clause
// Rastrum against OpenGL (llvmpipe): coverage, fragment counts, `phong`.
#include <bench/peers/check.hpp>
#include <bench/peers/gl_peer.hpp>
#include <bench/scenes.hpp>
#include <bench/stand_ins.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bench/gl_fixture.hpp"
#include "tests/support/oracle.hpp"

namespace rastrum::bench::gl_peer_test {
namespace {

using GlPeerTest = GlFixture<GlPeer>;

struct SizeCase {
  int width, height;
};
constexpr SizeCase kSizes[] = {{256, 256}, {1000, 700}, {1023, 517}};

/// The fragments of `window_triangles` by the oracle.
Image<std::uint32_t> exact_counts(const Mesh& mesh, int width, int height) {
  std::vector<test::SnappedTriangle> triangles(mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const Vec3 p = mesh.positions[mesh.indices[i]];
    triangles[i / 3].v[i % 3] = {std::llround(static_cast<double>(p.x) * 256),
                                 std::llround((height - static_cast<double>(p.y)) * 256), 0.5F};
  }
  Image<std::uint32_t> counts(width, height);
  std::ranges::copy(test::brute_force(width, height, triangles).overdraw, counts.pixels().begin());
  return counts;
}

// The peer is set up for our conventions. This tests it without our rasterizers.
TEST_F(GlPeerTest, KeepsTheTopLeftRule) {
  for (const auto [width, height] : kSizes) {
    const Mesh mesh = window_triangles(width, height, 2000, 7);
    gl_->set_mesh(mesh.view());
    gl_->set_view(window_camera(width, height), width, height);
    const auto exact = exact_counts(mesh, width, height);
    EXPECT_EQ(compare_counts(exact, gl_->fragment_counts()).pixels, 0U) << width << "x" << height;
    const auto all = exact.pixels();
    EXPECT_EQ(gl_->samples_passed(), std::accumulate(all.begin(), all.end(), std::uint64_t{0}));
  }
}

TEST_F(GlPeerTest, FirstSubmittedWinsEqualDepths) {
  Mesh mesh = window_triangles(64, 64, 1, 3);
  mesh.positions = {{0, 0, -0.5F}, {64, 0, -0.5F}, {0, 64, -0.5F}};
  mesh.indices = {0, 1, 2, 0, 1, 2};
  gl_->set_mesh(mesh.view());
  gl_->set_view(window_camera(64, 64), 64, 64);
  gl_->draw_ids();
  const Image<std::int32_t> ids = gl_->ids();
  EXPECT_EQ(ids(2, 60), 0);  // row 0 is at the top: the triangle is at the bottom left
  EXPECT_EQ(ids(60, 2), -1);
  EXPECT_EQ(std::ranges::count(ids.pixels(), 1), 0);
  EXPECT_NEAR(gl_->depths()(2, 60), 0.5F, 1e-6F);
  EXPECT_EQ(gl_->depths()(60, 2), 0);
}

TEST_F(GlPeerTest, ExactVerticesGiveTheSameCounts) {
  for (const auto [width, height] : kSizes)
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const Mesh mesh = window_triangles(width, height, 3000, seed);
      const GlCheck c = check_against(*gl_, mesh, window_camera(width, height), width, height, 2);
      EXPECT_EQ(c.counts.pixels, kDifferingPixelsExact) << width << "x" << height << ", " << seed;
      EXPECT_TRUE(c.passes(kDifferingPixelsExact));
    }
}

/// A scene by name, at two sizes.
class GlMeshTest : public GlPeerTest, public testing::WithParamInterface<const char*> {};

TEST_P(GlMeshTest, SameCountsAndPhong) {
  const SceneInfo& scene = scene_by_name(GetParam());
  if (!available(scene)) GTEST_SKIP() << "no " << scene.file << " in the shared data";
  const Mesh mesh = load(scene);
  for (const auto [width, height] : {SizeCase{1024, 1024}, SizeCase{1920, 1080}}) {
    const GlCheck c = check_against(*gl_, mesh, whole_view(mesh), width, height, 2);
    EXPECT_GT(c.colors.covered, 100'000U);
    EXPECT_LE(c.counts.pixels, kDifferingPixelsMesh) << width << "x" << height;
    EXPECT_GE(c.colors.share(), kPhongShare) << width << "x" << height;
    EXPECT_EQ(c.samples_passed, c.counts.theirs);
    EXPECT_EQ(c.stats_fragments, c.counts.ours);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GlMeshTest,
                         testing::Values("suzanne", "teapot", "bunny", "sponza", "dragon", "brain",
                                         "shape-teapot", "torus-knot", "gyroid"),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace rastrum::bench::gl_peer_test
