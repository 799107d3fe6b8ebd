// SPDX-License-Identifier: BSD-3-Clause
// The oracle against cases worked out by hand.
#include "tests/support/oracle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <vector>

namespace rastrum::test::oracle_test {
namespace {

SnappedTriangle px_triangle(std::array<double, 6> xy, std::array<float, 3> depth = {1, 1, 1},
                            std::int64_t id = 0) {
  SnappedTriangle t;
  t.id = id;
  for (std::size_t i = 0; i < 3; ++i)
    t.v[i] = {static_cast<std::int64_t>(xy[2 * i] * 256),
              static_cast<std::int64_t>(xy[2 * i + 1] * 256), depth[i]};
  return t;
}

/// One triangle in 8 × 8 pixels.
OracleImage drawn(const SnappedTriangle& t, Keep keep = Keep::all) {
  return brute_force(8, 8, std::array{t}, keep);
}

std::vector<int> row_counts(const OracleImage& image) {
  std::vector<int> counts(static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      counts[static_cast<std::size_t>(y)] +=
          static_cast<int>(image.overdraw[static_cast<std::size_t>(y * image.width + x)]);
  return counts;
}

// The corners lie on the samples (0.5, 0.5), (4.5, 0.5) and (0.5, 4.5). The left and the top edge
// own their samples, the diagonal does not.
TEST(Oracle, TopLeftRule) {
  const SnappedTriangle t = px_triangle({0.5, 0.5, 4.5, 0.5, 0.5, 4.5});
  EXPECT_EQ(row_counts(drawn(t)), (std::vector<int>{4, 3, 2, 1, 0, 0, 0, 0}));
  // The square's other half owns the diagonal, but neither its right nor its bottom edge.
  const SnappedTriangle u = px_triangle({4.5, 0.5, 4.5, 4.5, 0.5, 4.5});
  EXPECT_EQ(row_counts(drawn(u)), (std::vector<int>{0, 1, 2, 3, 0, 0, 0, 0}));
}

TEST(Oracle, WindingChangesNothingButTheSide) {
  const SnappedTriangle clockwise = px_triangle({0.5, 0.5, 4.5, 0.5, 0.5, 4.5});
  const SnappedTriangle counter = px_triangle({0.5, 0.5, 0.5, 4.5, 4.5, 0.5});
  EXPECT_GT(twice_area(clockwise), 0);
  EXPECT_LT(twice_area(counter), 0);
  for (const Keep keep : {Keep::all, Keep::front, Keep::back}) {
    EXPECT_EQ(drawn(clockwise, keep).fragments(), keep == Keep::front ? 0U : 10U);
    EXPECT_EQ(drawn(counter, keep).fragments(), keep == Keep::back ? 0U : 10U);
  }
}

TEST(Oracle, ExactAtTheEndsOfTheGuardBand) {
  // The hypotenuse from (−2¹⁵, 2¹⁶) to (2¹⁶, −2¹⁵) is x + y = 2¹⁵. No sample of an 8 × 8 image is
  // near it, and the two triangles are on opposite sides.
  const SnappedTriangle low = px_triangle({-32768, -32768, 65536, -32768, -32768, 65536});
  const SnappedTriangle high = px_triangle({65536, 65536, 65536, -32768, -32768, 65536});
  EXPECT_EQ(drawn(low).fragments(), 64U);
  EXPECT_EQ(drawn(high).fragments(), 0U);
  // One subpixel decides: the line y = x moved right by 1/256 px from the samples' diagonal.
  SnappedTriangle through = px_triangle({-32768, -32768, 65536, 65536, -32768, 65536});
  EXPECT_EQ(drawn(through).fragments(), 28U);
  for (SnappedVertex& v : through.v) v.x_fx8 += 1;
  through.v[1].x_fx8 -= 1;
  through.v[1].y_fx8 -= 1;
  through.v[2].x_fx8 -= 1;
  EXPECT_EQ(drawn(through).fragments(), 36U);
}

TEST(Oracle, FirstSubmittedWinsEqualDepths) {
  std::vector<SnappedTriangle> t;
  for (const int id : {7, 3, 5})
    t.push_back(px_triangle({0, 0, 8, 0, 0, 8}, {0.5F, 0.5F, 0.5F}, id));
  const OracleImage image = brute_force(8, 8, t);
  EXPECT_EQ(image.ids[0], 3);
  EXPECT_EQ(image.overdraw[0], 3U);
  EXPECT_EQ(image.ids[63], -1);
}

TEST(Oracle, NearestWinsAndDepthZeroIsStillDrawn) {
  const std::vector<SnappedTriangle> t = {
      px_triangle({0, 0, 16, 0, 0, 16}, {-1, -1, -1}, 0),
      px_triangle({0, 0, 4, 0, 0, 4}, {0.25F, 0.25F, 0.25F}, 1)};
  const OracleImage image = brute_force(8, 8, t);
  EXPECT_EQ(image.ids[0], 1);
  EXPECT_EQ(image.depth[0], 0.25F);
  EXPECT_EQ(image.ids[7], 0);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(image.depth[7]), 0U);
}

TEST(Oracle, DepthPlane) {
  // depth = x / 16 + y / 32, exact in float32 everywhere.
  const SnappedTriangle t = px_triangle({0, 0, 16, 0, 0, 16}, {0, 1, 0.5F});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(depth_at(t, x, y),
                (static_cast<float>(x) + 0.5F) / 16 + (static_cast<float>(y) + 0.5F) / 32);
  const SnappedTriangle beyond = px_triangle({0, 0, 16, 0, 0, 16}, {0.75F, 4, 0.75F});
  EXPECT_EQ(depth_at(beyond, 7, 0), 1.0F);
}

TEST(Oracle, RefusesWhatIsOutsideTheGuardBand) {
  EXPECT_THROW((void)drawn(px_triangle({-32769, 0, 8, 0, 0, 8})), std::out_of_range);
}

}  // namespace
}  // namespace rastrum::test::oracle_test
