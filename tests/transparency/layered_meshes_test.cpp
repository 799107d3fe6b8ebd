// SPDX-License-Identifier: BSD-3-Clause
// Real meshes and a ball of hair, drawn translucent, against the oracle: from the default camera,
// and from so near that triangles cross the near plane and the guard band.
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/random.hpp"
#include "tests/support/real_meshes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"
#include "tests/transparency/exactness.hpp"

namespace rastrum::test::layered_meshes_test {
namespace {

constexpr int kWidth = 203, kHeight = 149;

/// All triangles of `scene` in world space, with random colours of `alpha`.
LayerScene in_colors(const Scene& scene, float alpha) {
  LayerScene out;
  out.kind = "mesh";
  out.paint = Paint::pixel;
  Random random(5);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto first = static_cast<std::uint32_t>(out.mesh.positions.size());
    const auto& m = instance.object_to_world.m;
    for (const Vec3& p : mesh.positions) {
      const auto row = [&](int i) {
        return static_cast<float>(m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3]);
      };
      out.mesh.positions.push_back({row(0), row(1), row(2)});
    }
    const MeshView view = mesh.view();
    for (std::size_t t = 0; t < view.triangle_count(); ++t) {
      const auto corner = [&](std::size_t c) {
        const std::size_t i = 3 * t + c;
        return first + (mesh.indices.empty() ? static_cast<std::uint32_t>(i) : mesh.indices[i]);
      };
      const auto channel = [&] { return alpha * static_cast<float>(random.real(0, 1)); };
      const Vec4 color{channel(), channel(), channel(), alpha};
      out.add(corner(0), corner(1), corner(2), color);
    }
  }
  return out;
}

void expect_exact_near_and_far(LayerScene scene, std::uint32_t least_depth) {
  const Scene whole = single(scene.mesh);
  const SceneBinding binding(whole);
  const Camera cameras[] = {fit_camera(binding.view(), 1.0472F, false),
                            close_camera(binding.view())};
  const RenderOptions o(
      {.width = kWidth, .height = kHeight, .background = {0.1F, 0.2F, 0.3F, 0.5F}});
  for (const Camera& camera : cameras) {
    scene.camera = camera;
    const LayerImage oracle = oracle_of(scene, kWidth, kHeight, 1, o.background);
    EXPECT_GE(oracle.most_layers(), least_depth);
    LayerProgram program(scene, kWidth, kHeight);
    expect_exact(o, oracle, Check::all, [&](Painter& painter) {
      LayerPicture picture = take(painter, program);
      if (painter.options().rasterizer == "tiled") return picture;
      EXPECT_EQ(picture.counter("deepest"), oracle.most_layers());
      EXPECT_EQ(picture.counter("translucent fragments"),
                std::accumulate(oracle.layers.begin(), oracle.layers.end(), std::uint64_t{0}));
      EXPECT_EQ(picture.counter("repaired pixels"), picture.error_pixels());
      return picture;
    });
  }
}

class LayeredMeshes : public testing::TestWithParam<const char*> {};

TEST_P(LayeredMeshes, EqualTheOracle) {
  if (test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  const std::string file = GetParam();
  if (!std::filesystem::exists(shared_data(file))) GTEST_SKIP() << file << " is not there";
  const bool is_brain = file.find("brain") != std::string::npos;
  expect_exact_near_and_far(in_colors(io::read_scene(shared_data(file)), is_brain ? 0.3F : 0.5F),
                            1);
}

INSTANTIATE_TEST_SUITE_P(Shared, LayeredMeshes, testing::ValuesIn(kRealMeshes), name_of_file);

// In `./dev check --full` this is paper 4's, with 2.88 million triangles.
TEST(LayeredShapes, HairballEqualsTheOracle) {
  if (test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  if (!is_full())
    expect_exact_near_and_far(in_colors(single(shapes::hairball(3000, 48, 0.02F)), 0.1F), 60);
  else
    expect_exact_near_and_far(in_colors(single(shapes::hairball()), 0.1F), 30);
}

}  // namespace
}  // namespace rastrum::test::layered_meshes_test
