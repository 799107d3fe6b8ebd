// SPDX-License-Identifier: BSD-3-Clause
// Draws what python/tests/test_pictures.py draws by the package and by the program. All three must
// match the digests `as_python/…` of tests/golden/hashes.txt.
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/render.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::as_python_test {
namespace {

/// The numbers are exact, so only the ways of drawing could differ.
struct Sheet {
  std::vector<Vec3> positions{};
  std::vector<std::uint32_t> corners{};

  Sheet() {
    constexpr int kSide = 33;
    for (const auto& [x, y] : pixels(kSide, kSide))
      positions.push_back({static_cast<float>(x) / 16 - 1, static_cast<float>(y) / 16 - 1,
                           static_cast<float>((x * x * 7 + y * y * 5 + x * y * 3) % 64) / 256});
    for (const bool upper : {false, true})
      for (std::uint32_t y = 0; y + 1 < kSide; ++y)
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
          const std::uint32_t c = y * kSide + x;
          corners.insert(corners.end(), {c, upper ? c + 34 : c + 1, upper ? c + 33 : c + 34});
        }
  }
};

TEST(AsPython, TheLibraryFindsItsDigests) {
  const Sheet sheet;
  MeshView mesh{.positions = sheet.positions, .indices = sheet.corners};
  const OneInstance instance(mesh);
  Camera camera{.eye = {1, -2, 3},
                .target = {0, 0, 0},
                .fov_rad = static_cast<float>(60 * 3.14159265358979323846 / 180),
                .near_plane = 0.01F,
                .far_plane = std::numeric_limits<float>::infinity()};
  const Frame f = draw({.threads = 2}, instance.view(), camera,
                       {.width = 200, .height = 150, .shader = Shader::phong},
                       kColor8 | kDepth | kIds | kNormals | kPositions | kBarycentrics);
  EXPECT_TRUE(matches_golden("as_python/color", digest(f.color8)));
  EXPECT_TRUE(matches_golden("as_python/depth", digest(f.depth)));
  EXPECT_TRUE(matches_golden("as_python/ids", digest(f.ids)));
  EXPECT_TRUE(matches_golden("as_python/normals", digest(f.normals)));
  EXPECT_TRUE(matches_golden("as_python/positions", digest(f.positions)));
  EXPECT_TRUE(matches_golden("as_python/barycentrics", digest(f.barycentrics)));
}

}  // namespace
}  // namespace rastrum::test::as_python_test
