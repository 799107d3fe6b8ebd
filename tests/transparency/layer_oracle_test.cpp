// SPDX-License-Identifier: BSD-3-Clause
// The oracle of transparency against cases worked out by hand.
#include "tests/support/layer_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace rastrum::test::layer_oracle_test {
namespace {

/// The rectangle [x0, x1) × [0, 4) px; its two triangles have one id.
std::vector<SnappedTriangle> wall(std::int64_t id, double x0, double x1, float left, float right) {
  const auto at = [](double x, double y, float depth) {
    return SnappedVertex{std::llround(x * 256), std::llround(y * 256), depth};
  };
  const SnappedVertex a = at(x0, 0, left), b = at(x1, 0, right), c = at(x1, 4, right),
                      d = at(x0, 4, left);
  return {{{a, b, c}, id}, {{a, c, d}, id}};
}
std::vector<SnappedTriangle> flat(std::int64_t id, float depth) {
  return wall(id, 0, 4, depth, depth);
}

/// 4 × 4 pixels in which triangle i has the colour `colors[i]`.
struct Case {
  std::vector<SnappedTriangle> triangles;
  std::vector<Rgba64> colors;
  std::vector<std::int64_t> opaque;
  Rgba64 background;
  int samples = 1;

  Case& add(const std::vector<SnappedTriangle>& t) {
    triangles.insert(triangles.end(), t.begin(), t.end());
    return *this;
  }
  [[nodiscard]] LayerImage blend(LayerOrder order = LayerOrder::depth) const {
    LayerInput in;
    in.width = in.height = 4;
    in.samples = samples;
    in.triangles = triangles;
    in.is_opaque = [this](std::int64_t id) { return std::ranges::count(opaque, id) > 0; };
    in.color = [this](const SnappedTriangle& t, const ShadePoint&) {
      return colors[static_cast<std::size_t>(t.id)];
    };
    in.background = background;
    return blend_layers(in, order);
  }
};

void expect_color(const Rgba64& actual, const Rgba64& expected) {
  EXPECT_NEAR(actual.r, expected.r, 1e-15);
  EXPECT_NEAR(actual.g, expected.g, 1e-15);
  EXPECT_NEAR(actual.b, expected.b, 1e-15);
  EXPECT_NEAR(actual.a, expected.a, 1e-15);
}

constexpr Rgba64 kRed{0.25, 0, 0, 0.25}, kGreen{0, 0.5, 0, 0.5}, kBlue{0, 0, 1, 1};

TEST(LayerOracle, NearerLayersAreInFront) {
  Case c{{}, {kGreen, kRed}, {}, {0.5, 0.5, 0.5, 0.5}};
  c.add(flat(0, 0.25F)).add(flat(1, 0.75F));
  const LayerImage image = c.blend();
  // Red in front, green through 3/4, the background through 3/8.
  for (const Rgba64& pixel : image.color)
    expect_color(pixel, {0.25 + 0.1875, 0.375 + 0.1875, 0.1875, 0.25 + 0.375 + 0.1875});
  EXPECT_EQ(image.ids[5], 1);
  EXPECT_EQ(image.depth[5], 0.75F);
  EXPECT_EQ(image.layers[5], 2U);
  EXPECT_EQ(image.tied[5], 0);
}

TEST(LayerOracle, EqualLayersAddUp) {
  Case c;
  for (int i = 0; i < 50; ++i) {
    c.add(flat(i, 0.01F * static_cast<float>(i)));
    c.colors.push_back({0.02, 0.01, 0, 0.02});
  }
  const LayerImage image = c.blend();
  const double alpha = 1 - std::pow(0.98, 50);
  EXPECT_NEAR(image.color[15].a, alpha, 1e-14);
  EXPECT_NEAR(image.color[15].r, alpha, 1e-14);
  EXPECT_NEAR(image.color[15].g, alpha / 2, 1e-14);
  EXPECT_EQ(image.most_layers(), 50U);
}

TEST(LayerOracle, FirstSubmittedIsInFrontAtEqualDepth) {
  Case c{{}, {kGreen, kRed}, {}, {}};
  c.add(flat(1, 0.5F)).add(flat(0, 0.5F));
  const LayerImage image = c.blend();
  expect_color(image.color[0], {0.125, 0.5, 0, 0.625});
  EXPECT_EQ(image.ids[0], 0);
  EXPECT_EQ(image.tied[0], 1);
}

TEST(LayerOracle, OpaqueSurfacesHideWhatHasASmallerKey) {
  // 1 and 3 are in the plane of the opaque 2. 1 was submitted before it and survives.
  Case c{{}, {kRed, kGreen, kBlue, kGreen, kRed}, {2}, {1, 1, 1, 1}};
  c.add(flat(0, 0.25F)).add(flat(1, 0.5F)).add(flat(2, 0.5F)).add(flat(3, 0.5F));
  const LayerImage image = c.blend();
  expect_color(image.color[7], {0, 0.5, 0.5, 1});
  EXPECT_EQ(image.layers[7], 1U);
  EXPECT_EQ(image.tied[7], 1);
  EXPECT_EQ(image.ids[7], 1);
  // The oracle ignores the alpha of an opaque surface's colour.
  c.colors[2] = {0, 0, 1, 0.25};
  expect_color(c.blend().color[7], {0, 0.5, 0.5, 1});
  // Behind an opaque surface, equal depths do not matter.
  Case hidden{{}, {kRed, kRed, kBlue}, {2}, {}};
  hidden.add(flat(0, 0.25F)).add(flat(1, 0.25F)).add(flat(2, 0.5F));
  EXPECT_EQ(hidden.blend().tied[0], 0);
}

TEST(LayerOracle, PlanesCrossWithinThePicture) {
  // 0 slopes to the right, 1 is level: 0 is in front at the third and fourth column.
  Case c{{}, {kRed, kGreen}, {}, {}};
  c.add(wall(0, 0, 4, 0, 1)).add(flat(1, 0.5F));
  const LayerImage image = c.blend();
  for (std::size_t i = 0; i < 16; ++i)
    expect_color(image.color[i],
                 i % 4 < 2 ? Rgba64{0.125, 0.5, 0, 0.625} : Rgba64{0.25, 0.375, 0, 0.625});
}

TEST(LayerOracle, TheLaterIsInFrontWithoutSorting) {
  Case c{{}, {kRed, kGreen, kBlue, kGreen}, {2}, {}};
  c.add(flat(0, 0.9F)).add(flat(1, 0.8F)).add(flat(2, 0.3F)).add(flat(3, 0.1F));
  // 3 is hidden. 1 was submitted after 0 and so lies over it, although it is farther; both over the
  // opaque 2.
  expect_color(c.blend(LayerOrder::submission).color[3], {0.125, 0.5, 0.375, 1});
  expect_color(c.blend(LayerOrder::depth).color[3], {0.25, 0.375, 0.375, 1});
}

TEST(LayerOracle, HolesAreNotThere) {
  Case c{{}, {kRed, kGreen}, {}, {}};
  c.add(flat(0, 0.9F)).add(flat(1, 0.8F));
  LayerInput in;
  in.width = in.height = 4;
  in.triangles = c.triangles;
  in.color = [&](const SnappedTriangle& t, const ShadePoint&) {
    return c.colors[static_cast<std::size_t>(t.id)];
  };
  in.is_hole = [](const SnappedTriangle& t, const ShadePoint& p) { return t.id == 0 && p.px == 1; };
  const LayerImage image = blend_layers(in, LayerOrder::depth);
  expect_color(image.color[0], {0.25, 0.375, 0, 0.625});
  expect_color(image.color[1], kGreen);
  EXPECT_EQ(image.ids[1], 1);
}

// Every pattern has one sample in each of its rows and columns.
TEST(LayerOracle, StandardPositionsAreRooks) {
  for (const int n : {4, 8, 16}) {
    std::set<int> rows, columns;
    for (const SamplePosition& p : standard_positions(n)) {
      EXPECT_TRUE(p.x >= -8 && p.x < 8 && p.y >= -8 && p.y < 8);
      columns.insert((p.x + 8) * n / 16);
      rows.insert((p.y + 8) * n / 16);
    }
    EXPECT_EQ(standard_positions(n).size(), static_cast<std::size_t>(n));
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(columns.size(), static_cast<std::size_t>(n));
  }
  EXPECT_EQ(standard_positions(1).front().x, 0);
  EXPECT_THROW((void)standard_positions(2), std::invalid_argument);
}

// The left edge runs through the centres of the second column and owns their samples.
TEST(LayerOracle, SamplesAreCoveredOneByOne) {
  Case c{{}, {kBlue}, {}, {}};
  c.add(wall(0, 1.5, 4, 0.5F, 0.5F));
  const auto alpha = [&](int samples) {
    c.samples = samples;
    const LayerImage image = c.blend();
    EXPECT_EQ(image.color[4].a, 0);
    EXPECT_EQ(image.color[6].a, 1);
    EXPECT_EQ(image.ids[5], 0);
    return image.color[5].a;
  };
  EXPECT_EQ(alpha(1), 1);
  EXPECT_EQ(alpha(4), 0.5);   // x = 6 and 2 of −2, 6, −6, 2
  EXPECT_EQ(alpha(8), 0.5);   // 1, 5, 3, 7
  EXPECT_EQ(alpha(16), 0.5);  // 1, 4, 2, 5, 3, 0, 7, 6
}

TEST(LayerOracle, DepthIsThatOfTheSample) {
  // Depth 0 at the left border and 1 at the right one; 0.375 at the centre of the second column.
  Case c{{}, {kRed, kBlue}, {}, {}};
  c.add(wall(0, 0, 4, 0, 1)).add(flat(1, 0.375F));
  c.samples = 4;
  const LayerImage image = c.blend();
  // Samples right of the centre have red in front, (0.25, 0, 0.75); the others have blue.
  expect_color(image.color[5], {0.125, 0, 0.875, 1});
  EXPECT_EQ(image.depth[5], 0.375F + 0.25F * 6 / 16);
  EXPECT_EQ(image.ids[5], 0);
}

TEST(LayerOracle, ShadesAtTheCentreOrTheFirstCoveredSample) {
  std::vector<ShadePoint> points;
  LayerInput in;
  in.width = in.height = 4;
  in.samples = 4;
  in.color = [&](const SnappedTriangle&, const ShadePoint& p) {
    points.push_back(p);
    return kRed;
  };
  // Everything right of x = 1.6 px. In column 1 this misses the centre but covers the samples (6,
  // −2) and (2, 6); (6, −2) is the first.
  const std::array triangle{
      SnappedTriangle{{{410, -99999, 1}, {999999, 0, 1}, {410, 99999, 1}}, 0}};
  in.triangles = triangle;
  in.height = 1;
  (void)blend_layers(in, LayerOrder::depth);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].px, 1);
  EXPECT_EQ(points[0].x_fx8, 256 + 128 + 6 * 16);
  EXPECT_EQ(points[0].y_fx8, 128 - 2 * 16);
  EXPECT_EQ(points[1].px, 2);
  EXPECT_EQ(points[1].x_fx8, 2 * 256 + 128);
  EXPECT_EQ(points[1].y_fx8, 128);
}

}  // namespace
}  // namespace rastrum::test::layer_oracle_test
