// Real meshes through the whole family and the oracle: from the default camera, and from so near
// that triangles cross the near plane and the guard band.
#include <filesystem>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/pieces.hpp"
#include "tests/support/real_meshes.hpp"

namespace rastrum::test::meshes_test {
namespace {

class Meshes : public testing::TestWithParam<const char*> {};

TEST_P(Meshes, EqualOverTheFamilyAndTheOracle) {
  const std::filesystem::path file = shared_data(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Scene scene = io::read_scene(file);
  const SceneBinding binding(scene);
  RenderOptions base({.width = 203, .height = 149});
  base.shader = Shader::phong;  // all faces: `material` leaves the back of some out
  EveryWay ways(base);
  for (const Camera& camera :
       {fit_camera(binding.view(), 1.0472F, false), fit_camera(binding.view(), 1.0472F, true),
        close_camera(binding.view())}) {
    const Frame frame =
        ways.same([&](Painter& painter) { return draw(painter, binding.view(), camera); },
                  [](const Frame& got, const Frame& expected) {
                    EXPECT_TRUE(same_counts(got.stats, expected.stats));
                  });
    ASSERT_TRUE(counts_add_up(frame));
    const PieceList pieces = pieces_of(binding.view(), camera, base.width, base.height);
    const OracleImage oracle = brute_force(base.width, base.height, pieces.triangles);
    EXPECT_GT(oracle.pixels_covered(), 200U);
    ASSERT_TRUE(same_surfaces(frame, oracle));
    EXPECT_EQ(frame.stats.triangles.dropped, pieces.dropped);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, Meshes, testing::ValuesIn(kRealMeshes), name_of_file);

}  // namespace
}  // namespace rastrum::test::meshes_test
