// SPDX-License-Identifier: BSD-3-Clause
// Compares the pictures of the examples with recorded digests. tests/mpi tests Wave, which needs
// ranks of MPI.
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/digest.hpp>
#include <rastrum/io.hpp>
#include <rastrum/shapes.hpp>

#include "tests/io/files.hpp"
#include "tests/support/golden.hpp"

namespace rastrum::test::examples_test {
namespace {

class Examples : public testing::TestWithParam<const char*> {
 protected:
  /// Runs an example in this folder by its command line, without the program's folder.
  void run(const std::string& command) const {
    const std::string line =
        "cd '" + folder.path("").string() + "' && " RASTRUM_EXAMPLES "/" + command + " > out.txt";
    ASSERT_EQ(std::system(line.c_str()), 0) << line;
  }
  [[nodiscard]] Image<Rgba8> picture(const std::string& name) const {
    return io::read_image(folder.path(name + ".png"));
  }

  TempFolder folder;
};

TEST_P(Examples, DrawTheirPictures) {
  const std::string name = GetParam();
  ASSERT_NO_FATAL_FAILURE(run(name));
  EXPECT_TRUE(matches_golden("examples/" + name, digest(picture(name))));
}
INSTANTIATE_TEST_SUITE_P(All, Examples,
                         testing::Values("custom_shader", "family_row", "fem_surface", "gearbox",
                                         "molecule", "ranks_of_threads", "terrain_mesh"));

TEST_F(Examples, CustomShaderWritesItsSecondOutput) {
  ASSERT_NO_FATAL_FAILURE(run("custom_shader"));
  EXPECT_TRUE(matches_golden("examples/custom_shader_normals",
                             digest(io::read_light(folder.path("custom_shader_normals.exr")))));
}

TEST_F(Examples, RobotCameraWritesTheLastFrame) {
  ASSERT_NO_FATAL_FAILURE(run("robot_camera"));
  EXPECT_TRUE(matches_golden("examples/robot_camera", digest(picture("robot"))));
  const Image<float> metres = io::read_heights(folder.path("robot_depth.npy")).heights;
  EXPECT_TRUE(matches_golden("examples/robot_camera_depth", digest(metres)));
}

TEST_F(Examples, ServerAnswersEveryRequest) {
  ASSERT_NO_FATAL_FAILURE(run("server"));
  for (const int i : {0, 11})
    EXPECT_TRUE(matches_golden("examples/server" + std::to_string(i),
                               digest(picture("server" + std::to_string(i)))));
}

TEST_F(Examples, OutOfCoreDrawsWhatMemoryDraws) {
  io::write_ply(folder.path("mesh.ply"), shapes::gyroid(96, 3));
  ASSERT_NO_FATAL_FAILURE(run("render_file mesh.ply in_memory.png"));
  ASSERT_NO_FATAL_FAILURE(run("out_of_core mesh.ply out_of_core.png"));
  EXPECT_EQ(digest(picture("out_of_core")), digest(picture("in_memory")));
}

}  // namespace
}  // namespace rastrum::test::examples_test
