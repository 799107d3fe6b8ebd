// Files that are valid but rare.
#include <string>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>

#include "tests/io/files.hpp"
#include "tests/odd/trouble.hpp"

namespace rastrum::odd {
namespace {

Scene read(const std::string& name, const std::string& bytes) {
  const test::TempFolder folder;
  return io::read_scene(folder.write(name, bytes));
}

void face_of_two_corners() {
  const Scene scene = read("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n");
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_EQ(scene.warnings.size(), 1U);
}

}  // namespace

std::vector<Trouble> file_troubles() {
  return {
      {"Off_FaceOfTwoCorners", "an OFF file has a face of two corners",
       "the face is left out with one warning, the others are drawn", face_of_two_corners},
  };
}

}  // namespace rastrum::odd
