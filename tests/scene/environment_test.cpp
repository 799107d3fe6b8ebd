// SPDX-License-Identifier: BSD-3-Clause
// Environments: what surfaces gather and mirror, against float64 integrals over the picture.
#include <rastrum/environment.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/scene/environment_map.hpp>

#include "tests/support/refused.hpp"
#include "tests/support/small_environment.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::environment_test {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3d direction(double u, double v) {  // of the picture, in [0, 1]
  const double across = 2 * kPi * (u - 0.5), down = kPi * v;
  return {std::sin(down) * std::sin(across), std::cos(down), -std::sin(down) * std::cos(across)};
}

Image<Vec3> picture_of(int rows, const std::function<Vec3(Vec3d)>& light) {
  Image<Vec3> picture(2 * rows, rows);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < 2 * rows; ++x)
      picture(x, y) = light(direction((x + 0.5) / (2 * rows), (y + 0.5) / rows));
  return picture;
}

std::vector<Vec3d> directions() {
  std::vector<Vec3d> all{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < 60; ++i) all.push_back(direction(std::fmod(i * 0.618, 1), (i + 0.5) / 60));
  return all;
}

double gathered(const environment_detail::Gathered& g, int c, Vec3d n) {
  const double(&s)[6] = g.bend[c];
  const double mean[3] = {g.mean.x, g.mean.y, g.mean.z};
  return mean[c] + dot(g.rise[c], n) + s[0] * n.x * n.x + s[1] * n.y * n.y + s[2] * n.z * n.z +
         s[3] * n.x * n.y + s[4] * n.y * n.z + s[5] * n.z * n.x;
}

// A picture that is a polynomial of degree 2 has no higher bands, so a surface gathers exactly ∫ L
// max(n·w, 0) dw / π: 1, 2/3 and 1/4 of its bands.
TEST(Environments, GatherTheCosineIntegralOfSmoothPictures) {
  if (test::test_share() < 100) GTEST_SKIP() << test::kOnlyWhole;
  const auto light = [](Vec3d w) {
    return Vec3(
        Vec3d{1, 1 + 0.5 * w.x - 0.3 * w.z, 1 + 0.8 * w.x * w.y + 0.4 * (w.z * w.z - 1.0 / 3)});
  };
  const Environment environment(picture_of(128, light).view());
  const auto& g = environment.data().gathered;
  for (const Vec3d n : directions()) {
    EXPECT_NEAR(gathered(g, 0, n), 1, 1e-4);
    EXPECT_NEAR(gathered(g, 1, n), 1 + (0.5 * n.x - 0.3 * n.z) * 2 / 3, 1e-4);
    EXPECT_NEAR(gathered(g, 2, n), 1 + (0.8 * n.x * n.y + 0.4 * (n.z * n.z - 1.0 / 3)) / 4, 1e-4);
  }
  EXPECT_NEAR(environment.mean().y, 1, 1e-5);
}

TEST(Environments, MirrorThePictureWhereSmooth) {
  if (test::test_share() < 100) GTEST_SKIP() << test::kOnlyWhole;
  const auto light = [](Vec3d w) { return Vec3(Vec3d{2 + w.x, 2 + w.y, 2 + std::sin(3 * w.z)}); };
  const Environment environment(picture_of(256, light).view());
  for (const Vec3d d : directions()) {
    const Vec3 seen = environment.data().map.at(Vec3(d * 3.0), 0), wanted = light(d);
    EXPECT_NEAR(seen.x, wanted.x, 0.01);
    EXPECT_NEAR(seen.y, wanted.y, 0.01);
    EXPECT_NEAR(seen.z, wanted.z, 0.03);
  }
}

TEST(Environments, BlurByTheFacetsOfARoughness) {
  if (test::test_share() < 100) GTEST_SKIP() << test::kOnlyWhole;
  const Image<Vec3> picture = builtin_environment(BuiltinEnvironment::room);
  const Environment environment(picture.view());
  for (const int level : {2, 4, 7}) {
    const double roughness = level / 7.0, alpha2 = std::pow(roughness, 4);
    double worst = 0;
    for (const Vec3d n : directions()) {
      double sum = 0, weight = 0;
      for (int y = 0; y < picture.height(); y += 2)
        for (int x = 0; x < picture.width(); x += 2) {
          const double v = (y + 1.0) / picture.height();
          const Vec3d l = direction((x + 1.0) / picture.width(), v);
          const double n_l = dot(n, l);
          if (n_l <= 0) continue;
          const double n_h2 = (1 + n_l) / 2, lobe = n_h2 * (alpha2 - 1) + 1;
          const double share = n_l / (lobe * lobe) * std::sin(kPi * v);
          const double light = (static_cast<double>(picture(x, y).x) + picture(x + 1, y).x +
                                picture(x, y + 1).x + picture(x + 1, y + 1).x) /
                               4;
          sum += share * light;
          weight += share;
        }
      const double seen = environment.data().map.at(Vec3(n), static_cast<float>(roughness)).x;
      worst = std::max(worst, std::abs(seen - sum / weight) / std::max(1.0, sum / weight));
    }
    // Lamps with sharp edges in lobes of a few degrees, where 128² texels are about one degree
    // apart.
    EXPECT_LT(worst, level == 2 ? 0.06 : 0.01) << "level " << level;
  }
}

TEST(Environments, KeepWhatIsConstant) {
  const Environment environment(picture_of(16, [](Vec3d) { return Vec3{0.5F, 2, 0}; }).view());
  for (const Vec3d d : directions())
    for (const float roughness : {0.0F, 0.045F, 0.3F, 0.71F, 1.0F}) {
      const Vec3 seen = environment.data().map.at(Vec3(d), roughness);
      EXPECT_NEAR(seen.x, 0.5, 1e-5);
      EXPECT_NEAR(seen.y, 2, 1e-5);
      EXPECT_EQ(seen.z, 0);
    }
}

TEST(Environments, HaveNoSeams) {
  const Environment environment(small_environment(BuiltinEnvironment::sky).view());
  const EnvironmentMap& map = environment.data().map;
  // Across the fold at y = 0, and across the edges below, where the four flaps meet.
  for (int i = 0; i < 400; ++i) {
    const double a = 2 * kPi * i / 400;
    for (const float roughness : {0.5F, 1.0F}) {
      const Vec3d flat{std::cos(a), 0, std::sin(a)};
      const Vec3 above = map.at(Vec3(flat + Vec3d{0, 1e-4, 0}), roughness);
      const Vec3 below = map.at(Vec3(flat - Vec3d{0, 1e-4, 0}), roughness);
      EXPECT_NEAR(above.x, below.x, 2e-3);
      const Vec3d along{0, -1.0 - i * 0.01, 1};
      const Vec3 left = map.at(Vec3(along - Vec3d{1e-4, 0, 0}), roughness);
      const Vec3 right = map.at(Vec3(along + Vec3d{1e-4, 0, 0}), roughness);
      EXPECT_NEAR(left.x, right.x, 2e-3);
    }
  }
}

TEST(Environments, AreTheSameBitsForEveryNumberOfThreads) {
  const Image<Vec3> picture = small_environment(BuiltinEnvironment::sky);
  const Environment one(picture.view(), 1), three(picture.view(), 3);
  EXPECT_EQ(one.mean(), three.mean());
  for (int k = 0; k < EnvironmentMap::kLevels; ++k) {
    const auto& a = one.data().texels[k];
    const auto& b = three.data().texels[k];
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(0, std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec4))) << k;
  }
}

TEST(Environments, ThatCannotBeAreRefused) {
  const auto refused = [](const char* part, ImageView<const Vec3> picture) {
    expect_refused(part, [&] { const Environment e(picture); });
  };
  refused("twice as wide as high", Image<Vec3>(32, 32).view());
  refused("twice as wide as high", {});
  for (const float bad :
       {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image<Vec3> picture(8, 4);
    picture(5, 2).y = bad;
    refused("pixel (5, 2)", picture.view());
  }
}

// Directions that are zero or not finite must not read out of bounds.
TEST(Environments, AreBlackWhereThereIsNoDirection) {
  const Environment environment(picture_of(4, [](Vec3d) { return Vec3{1, 1, 1}; }).view());
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const Vec3 d : {Vec3{}, Vec3{kInf, 0, 0}, Vec3{kInf - kInf, 1, 0}, Vec3{3e38F, 3e38F, 0}})
    EXPECT_EQ(environment.data().map.at(d, 0.5F), Vec3{});
}

}  // namespace
}  // namespace rastrum::test::environment_test
