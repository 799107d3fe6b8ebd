// SPDX-License-Identifier: BSD-3-Clause
// Every point of the coverage × visibility table draws the serial reference's bits. Each point is a
// test of its own, so that failures name the row: on generated scenes, on meshes, in several
// passes, with every number of threads, and on real meshes up to 8192² (label `full`). The real
// meshes are also compared with the oracle, from the default camera and from so near that triangles
// cross the near plane and the guard band.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/every_way.hpp"
#include "tests/support/family.hpp"
#include "tests/support/pieces.hpp"
#include "tests/support/real_meshes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::table_test {
namespace {

class Table : public testing::TestWithParam<TablePoint> {
 protected:
  static RenderOptions serial(int width, int height) {
    return RenderOptions({.width = width, .height = height}, {.device = Device::serial});
  }
  /// The point, with the n-th combination of threads and instruction sets.
  static RenderOptions point(int width, int height, int n) {
    static const std::vector<Isa> isas = available_isas();
    static constexpr int kThreads[] = {1, 2, 8};
    return RenderOptions(
        {.width = width, .height = height},
        {.threads = kThreads[n % 3], .isa = isas[static_cast<std::size_t>(n / 3) % isas.size()]},
        GetParam());
  }
  static int combinations() { return 3 * static_cast<int>(available_isas().size()); }
};

TEST_P(Table, EqualsSerialOnGeneratedScenes) {
  const int scenes = share_of(120, 5);
  constexpr int kSizes[][2] = {{64, 64}, {37, 53}, {128, 96}, {1, 1}, {100, 20}};
  int failures = 0;
  for (int s = 0; s < static_cast<int>(std::size(kSizes)); ++s) {
    const auto [width, height] = kSizes[s];
    Painter reference(serial(width, height));
    std::vector<Painter> renderers;
    for (int n = 0; n < combinations(); ++n) renderers.emplace_back(point(width, height, n));
    for (int i = 0; i < scenes / static_cast<int>(std::size(kSizes)); ++i) {
      const auto seed = static_cast<std::uint64_t>(s * 1000000 + i);
      const GeneratedScene g = generate(seed, width, height);
      Painter& renderer = renderers[static_cast<std::size_t>(i) % renderers.size()];
      SCOPED_TRACE(testing::Message() << "scene " << seed << " (" << g.kind << "), "
                                      << test::name_of(renderer.options()));
      const Frame expected = draw(reference, g.view(), g.camera);
      const Frame actual = draw(renderer, g.view(), g.camera);
      EXPECT_TRUE(same_frames(actual, expected));
      EXPECT_TRUE(counts_add_up(actual));
      if (HasFailure() && ++failures == 3) FAIL() << "the rest was not drawn";
    }
  }
}

TEST_P(Table, EqualsSerialOnMeshes) {
  for (const char* spec : {"torus_knot", "soup?count=4000", "boxes"}) {
    const Fitted mesh(shapes::from_spec(spec));
    for (const int size : {64, 200, 256}) {
      SCOPED_TRACE(std::string(spec) + " at " + std::to_string(size));
      Painter reference(serial(size, size));
      const Frame expected = draw(reference, mesh.view, mesh.camera);
      EXPECT_GT(expected.stats.pixels_covered, 200U);
      // Sanitizer runs use each number of threads and each instruction set once.
      const int step = test_share() < 100 ? 4 : 1;
      for (int n = 0; n < combinations(); n += step) {
        Painter renderer(point(size, size, n));
        const Frame actual = draw(renderer, mesh.view, mesh.camera);
        ASSERT_TRUE(same_surfaces(actual, expected)) << n;
        ASSERT_TRUE(same_counts(actual.stats, expected.stats)) << n;
      }
    }
  }
}

// Two runs of anything give the same bytes, colours included.
TEST_P(Table, IsTheSameAtEveryRun) {
  const GeneratedScene g = generate(12345, 128, 96);
  Painter renderer(point(128, 96, 2));
  const Frame first = draw(renderer, g.view(), g.camera);
  for (int i = 0; i < 3; ++i) {
    const Frame again = draw(renderer, g.view(), g.camera);
    ASSERT_TRUE(same_images(again, first));
    EXPECT_EQ(again.stats.counters, first.stats.counters);
  }
}

class RealMeshes : public testing::TestWithParam<const char*> {};

// Hours on two cores, so only `./dev check --full` runs it.
TEST_P(RealMeshes, EqualSerialAtEverySizeAndPoint) {
  if (!is_full()) GTEST_SKIP() << kOnlyFull;
  const std::filesystem::path file = shared_data(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Fitted mesh(io::read_scene(file));
  constexpr int kSizes[][2] = {{1, 1}, {64, 64}, {1920, 1080}, {4096, 4096}, {8192, 8192}};
  for (const auto& [width, height] : kSizes) {
    RenderOptions options({.width = width, .height = height});
    options.transparency.method = Transparency::none;  // every point of the table draws it
    options.device = Device::serial;
    // Without colours, which would need too much memory at these sizes.
    const Frame expected = draw(options, mesh.view, mesh.camera, kVisible);
    options.device = Device::threads;
    for (const TablePoint& point : table_points()) {
      static_cast<family::Row&>(options) = point;
      EXPECT_TRUE(same_images(draw(options, mesh.view, mesh.camera, kVisible), expected))
          << test_name(point) << " at " << width;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RealMeshes, testing::ValuesIn(kRealMeshes), name_of_file);

class Meshes : public testing::TestWithParam<const char*> {};

TEST_P(Meshes, EqualOverTheFamilyAndTheOracle) {
  const std::filesystem::path file = shared_data(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Fitted mesh(io::read_scene(file));
  RenderOptions base({.width = 203, .height = 149});
  base.shader = Shader::phong;  // unlike `material`, it draws the back of all faces
  EveryWay ways(base);
  for (const Camera& camera :
       {mesh.camera, fit_camera(mesh.view, 1.0472F, true), close_camera(mesh.view)}) {
    const Frame frame =
        ways.same([&](Painter& painter) { return draw(painter, mesh.view, camera); }, kCountsToo);
    ASSERT_TRUE(counts_add_up(frame));
    const PieceList pieces = pieces_of(mesh.view, camera, base.width, base.height);
    const OracleImage oracle = brute_force(base.width, base.height, pieces.triangles);
    EXPECT_GT(oracle.pixels_covered(), 200U);
    ASSERT_TRUE(same_surfaces(frame, oracle));
    EXPECT_EQ(frame.stats.triangles.dropped, pieces.dropped);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, Meshes, testing::ValuesIn(kRealMeshes), name_of_file);

INSTANTIATE_TEST_SUITE_P(Points, Table, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

}  // namespace
}  // namespace rastrum::test::table_test
