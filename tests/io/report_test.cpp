// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io.hpp>

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

#include "tests/support/refused.hpp"

namespace rastrum::test::report_test {
namespace {

// A scene that no reader made may have references out of range.
TEST(Describe, RefusesIndicesOutOfRange) {
  Scene good;
  good.meshes.resize(2);
  good.meshes[1].positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  good.meshes[1].indices = {0, 1, 2};
  good.instances.resize(1);  // of the mesh without triangles; the other one is read too
  good.materials.resize(1);
  EXPECT_TRUE(holds(io::describe(good), "mesh 1"));
  const auto expect = [&](const char* part, const std::function<void(Scene&)>& change) {
    Scene scene = good;
    change(scene);
    expect_refused(part, [&] { static_cast<void>(io::describe(scene)); });
  };
  expect("is vertex 4000000000", [](Scene& s) { s.meshes[1].indices[1] = 4'000'000'000; });
  expect("an instance is of mesh 9", [](Scene& s) { s.instances[0].mesh = 9; });
  expect("alpha mode is 200",
         [](Scene& s) { s.materials[0].alpha_mode = static_cast<AlphaMode>(200); });
}

TEST(Describe, NamesScalarsWithTheirRange) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.scalars = {{"heat", {1.5, -2, std::numeric_limits<double>::infinity()}}};
  scene.instances.resize(1);
  EXPECT_TRUE(holds(io::describe(scene), "scalars heat: 3 values, -2 to 1.5, 1 not finite"));
}

}  // namespace
}  // namespace rastrum::test::report_test
