// SPDX-License-Identifier: BSD-3-Clause
// Cameras that ranks fit to their parts equal one scene's, bit for bit.
#include <cstring>

#include <gtest/gtest.h>

#include "tests/ranks/parts_picture.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::ranks_fit_test {
namespace {

void expect_same(const Camera& a, const Camera& b, const char* what) {
  EXPECT_EQ(std::memcmp(&a.eye, &b.eye, sizeof(a.eye)), 0) << what;
  EXPECT_EQ(std::memcmp(&a.target, &b.target, sizeof(a.target)), 0) << what;
  EXPECT_EQ(a.near_plane, b.near_plane) << what;
  EXPECT_EQ(a.far_plane, b.far_plane) << what;
  EXPECT_EQ(a.orthographic_height, b.orthographic_height) << what;
}

TEST(FitOfRanks, SeesWhatOneSceneHas) {
  constexpr std::size_t kCount = 12;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const PartsScene parts(seed, kCount, false);
    const SceneBinding binding(parts.scene);
    for (const std::size_t n : {1U, 2U, 5U, 20U}) {
      LocalRanks ranks(static_cast<int>(n));
      ranks.run([&](Communicator& c) {
        const auto r = static_cast<std::size_t>(c.rank());
        SceneView own = binding.view();
        own.instances =
            own.instances.subspan(r * kCount / n, (r + 1) * kCount / n - r * kCount / n);
        FitOfRanks fit(c);
        for (const bool orthographic : {false, true}) {
          Camera along{.eye = {1, 1, 1}, .target = {0, 0, 0}, .orthographic = orthographic};
          expect_same(fit_picture(binding.view(), along, 300, 200),
                      fit_picture(own, along, 300, 200, {.ranks = &fit}), "picture");
          expect_same(fit_camera(binding.view(), 0.9F, orthographic, {1, -2, 3}),
                      fit_camera(own, 0.9F, orthographic, {1, -2, 3}, {0, 1, 0}, &fit), "ball");
        }
      });
    }
  }
}

TEST(FitOfRanks, OfNothingIsThatOfNothing) {
  LocalRanks ranks(3);
  ranks.run([](Communicator& c) {
    FitOfRanks fit(c);
    expect_same(fit_picture({}, {}, 30, 20), fit_picture({}, {}, 30, 20, {.ranks = &fit}),
                "picture");
    expect_same(fit_camera({}, 1, false), fit_camera({}, 1, false, {0, 0, -1}, {0, 1, 0}, &fit),
                "ball");
  });
}

TEST(FitOfRanks, WhatOneRankCannotReadAllSay) {
  Mesh mesh = shapes::soup(3);
  mesh.indices = {0, 1, 1000};
  const MeshView view = mesh.view();
  const InstanceView bad{view};
  LocalRanks ranks(3);
  expect_refused("rank 1: ", [&] {
    ranks.run([&](Communicator& c) {
      SceneView own;
      if (c.rank() == 1) own.instances = std::span(&bad, 1);
      FitOfRanks fit(c);
      (void)fit_picture(own, {}, 30, 20, {.ranks = &fit});
    });
  });
}

}  // namespace
}  // namespace rastrum::test::ranks_fit_test
