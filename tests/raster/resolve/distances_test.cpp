// SPDX-License-Identifier: BSD-3-Clause
// A block's distances from its keys: every instruction set against the formulas of docs/outputs.md
// ("Depth in world units"), for each kind of camera.
#include <rastrum/raster/resolve/distances.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <rastrum/raster/resolve/surface_point.hpp>

namespace rastrum::raster::distances_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kWidth = 320, kHeight = 200;

double formula(const Camera& c, double d) {
  const double n = c.near_plane, f = c.far_plane;
  if (c.orthographic) return f - d * (f - n);
  return f == static_cast<double>(kInfinity) ? n / d : n * f / (d * (f - n) + n);
}

/// Empty, the far plane with an id, the near plane, denormals, and depths between them.
void make_keys(std::uint64_t seed, std::uint64_t* keys) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < 64; ++i) {
    const float depths[] = {0, 1, 1e-41F, std::ldexp(1.0F, -static_cast<int>(random() % 60)),
                            static_cast<float>(random() % 100000) / 100000};
    const float depth = depths[random() % 5];
    keys[i] = std::uint64_t{std::bit_cast<std::uint32_t>(depth)} << kIdBits | random() % 1000;
    if (random() % 8 == 0) keys[i] = 0;
  }
}

TEST(Distances, AreTheFormulasBitsOnEveryInstructionSet) {
  Camera perspective{.eye = {1, 2, 3}, .target = {0.1, 0.2, -0.3}, .near_plane = 0.1F};
  Camera finite = perspective, orthographic = perspective;
  finite.far_plane = 70;
  orthographic.far_plane = 70;
  orthographic.orthographic = true;
  // The same camera as `finite`, by its matrix.
  const Camera by_matrix =
      camera_from_matrix(world_to_clip(finite, kWidth, kHeight), ClipDepth::reversed);
  for (const Camera& camera : {perspective, finite, orthographic, by_matrix}) {
    const SceneView nothing;
    SurfaceScene scene(nothing, nullptr, camera, kWidth, kHeight);
    scene.distance_by_depth = distance_by_depth(camera);
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      alignas(64) std::uint64_t keys[64];
      make_keys(seed, keys);
      const int x0 = static_cast<int>(seed) % 40 * 8, y0 = static_cast<int>(seed) % 25 * 8;
      for (const Isa isa : available_isas()) {
        alignas(64) float z[64], away[64], alone[64];
        const float no_distance = seed % 2 == 0 ? kInfinity : 0;
        distance_kernel(isa)(scene, keys, x0, y0, no_distance, z, away);
        distance_kernel(isa)(scene, keys, x0, y0, no_distance, alone, nullptr);
        for (int i = 0; i < 64; ++i) {
          const auto d = std::bit_cast<float>(static_cast<std::uint32_t>(keys[i] >> kIdBits));
          ASSERT_EQ(alone[i], z[i]);
          if (!(d > 0)) {
            ASSERT_EQ(z[i], no_distance);
            ASSERT_EQ(away[i], no_distance);
            continue;
          }
          const double wide = view_distance(camera, d);
          ASSERT_EQ(z[i], static_cast<float>(wide)) << name(isa) << ", depth " << d;
          if (camera.matrix)
            ASSERT_NEAR(wide, formula(finite, double{d}), 1e-6 * wide);
          else
            ASSERT_EQ(wide, formula(camera, double{d}));
          ASSERT_EQ(away[i], static_cast<float>(wide * scene.ray_length(x0 + i % 8, y0 + i / 8)))
              << name(isa) << ", depth " << d;
        }
      }
    }
  }
}

}  // namespace
}  // namespace rastrum::raster::distances_test
