// Real meshes through the whole family and the oracle: from the default camera, and from so near
// that triangles cross the near plane and the guard band.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
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
  RenderOptions base;
  base.width = 203;
  base.height = 149;
  base.shader = Shader::phong;  // all faces: `material` leaves the back of some out
  std::vector<Frame> reference;
  const Camera cameras[] = {fit_camera(binding.view(), 1.0472F, false),
                            fit_camera(binding.view(), 1.0472F, true),
                            close_camera(binding.view())};
  for (const Relative& r : family_of(base)) {
    Painter renderer(r.options);
    for (std::size_t i = 0; i < std::size(cameras); ++i) {
      SCOPED_TRACE(r.name + ", camera " + std::to_string(i));
      const Frame frame = draw(renderer, binding.view(), cameras[i]);
      ASSERT_TRUE(counts_add_up(frame));
      if (r.options.device == Device::serial) {
        const PieceList pieces = pieces_of(binding.view(), cameras[i], base.width, base.height);
        const OracleImage oracle = brute_force(base.width, base.height, pieces.triangles);
        EXPECT_GT(oracle.pixels_covered(), 200U);
        ASSERT_TRUE(same_surfaces(frame, oracle));
        EXPECT_EQ(frame.stats.triangles.dropped, pieces.dropped);
        reference.push_back(frame);
        continue;
      }
      ASSERT_TRUE(same_surfaces(frame, reference[i]));
      ASSERT_TRUE(same_counts(frame.stats, reference[i].stats));
      ASSERT_TRUE(same_picture(frame, reference[i], 0));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, Meshes, testing::ValuesIn(kRealMeshes), name_of_file);

}  // namespace
}  // namespace rastrum::test::meshes_test
