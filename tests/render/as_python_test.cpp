// The library draws here what python/tests/test_pictures.py draws by the package and by the
// program: all three find the digests `as_python/…` of tests/golden/hashes.txt.
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/image.hpp>
#include <rastrum/render.hpp>

#include "tests/support/golden.hpp"

namespace rastrum::test::as_python_test {
namespace {

/// The numbers are exact, so that only the ways of drawing could make a difference.
struct Sheet {
  std::vector<Vec3> positions{};
  std::vector<std::uint32_t> corners{};

  Sheet() {
    constexpr int kSide = 33;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
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
  const InstanceView instance{mesh};
  SceneView scene{.instances = {&instance, 1}};
  Camera camera{.eye = {1, -2, 3},
                .target = {0, 0, 0},
                .fov_rad = static_cast<float>(60 * 3.14159265358979323846 / 180),
                .near_plane = 0.01F,
                .far_plane = std::numeric_limits<float>::infinity()};
  constexpr int kWidth = 200, kHeight = 150;
  Image<Rgba8> color(kWidth, kHeight);
  Image<float> depth(kWidth, kHeight);
  Image<std::int64_t> ids(kWidth, kHeight);
  Image<Vec3> normals(kWidth, kHeight), positions(kWidth, kHeight);
  Image<Vec2> barycentrics(kWidth, kHeight);
  Targets targets{.color8 = color,
                  .depth = depth,
                  .ids = ids,
                  .barycentrics = barycentrics,
                  .positions = positions,
                  .normals = normals};
  Renderer renderer({.threads = 2});
  FrameOptions frame{.width = kWidth, .height = kHeight, .shader = Shader::phong};
  renderer.render(scene, camera, frame, targets);
  EXPECT_TRUE(matches_golden("as_python/color", digest(color)));
  EXPECT_TRUE(matches_golden("as_python/depth", digest(depth)));
  EXPECT_TRUE(matches_golden("as_python/ids", digest(ids)));
  EXPECT_TRUE(matches_golden("as_python/normals", digest(normals)));
  EXPECT_TRUE(matches_golden("as_python/positions", digest(positions)));
  EXPECT_TRUE(matches_golden("as_python/barycentrics", digest(barycentrics)));
}

}  // namespace
}  // namespace rastrum::test::as_python_test
