// Every point of the coverage × visibility table draws the bits of the serial reference, each in a
// test of its own, so that a broken row is named: on generated scenes, on meshes, in several
// passes, with every number of threads, and on the real meshes up to 8192² (label `full`).
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/painter.hpp"
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
  /// The point, on the n-th of all combinations of threads and instruction sets.
  static RenderOptions point(int width, int height, int n) {
    static const std::vector<Isa> isas = available_isas();
    static constexpr int kThreads[] = {1, 2, 8};
    RenderOptions o = serial(width, height);
    o.device = Device::threads;
    o.rasterizer = GetParam().rasterizer;
    o.visibility = GetParam().visibility;
    o.threads = kThreads[n % 3];
    o.isa = isas[static_cast<std::size_t>(n / 3) % isas.size()];
    return o;
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
      SCOPED_TRACE("scene " + std::to_string(seed) + " (" + g.kind + "), " +
                   std::to_string(renderer.options().threads) + " threads, " +
                   std::string(name(*renderer.options().isa)));
      const Frame expected = draw(reference, g.view(), g.camera);
      const Frame actual = draw(renderer, g.view(), g.camera);
      EXPECT_TRUE(same_surfaces(actual, expected));
      EXPECT_TRUE(same_counts(actual.stats, expected.stats));
      EXPECT_TRUE(counts_add_up(actual));
      EXPECT_TRUE(same_picture(actual, expected, 0));
      if (HasFailure() && ++failures == 3) FAIL() << "the rest was not drawn";
    }
  }
}

TEST_P(Table, EqualsSerialOnMeshes) {
  for (const char* spec : {"torus_knot", "soup?count=4000", "boxes"}) {
    const Scene scene = single(shapes::from_spec(spec));
    const SceneBinding binding(scene);
    const Camera camera = fit_camera(binding.view(), 1.0472F, false);
    for (const int size : {64, 200, 256}) {
      SCOPED_TRACE(std::string(spec) + " at " + std::to_string(size));
      Painter reference(serial(size, size));
      const Frame expected = draw(reference, binding.view(), camera);
      EXPECT_GT(expected.stats.pixels_covered, 200U);
      // Sanitizers see each number of threads and each instruction set once.
      const int step = test_share() < 100 ? 4 : 1;
      for (int n = 0; n < combinations(); n += step) {
        Painter renderer(point(size, size, n));
        const Frame actual = draw(renderer, binding.view(), camera);
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
    ASSERT_TRUE(same_surfaces(again, first));
    ASSERT_TRUE(same_picture(again, first, 0));
    EXPECT_EQ(again.stats.counters, first.stats.counters);
  }
}

/// Ids and depth only: at these sizes colours would take the memory of the rest.
Frame surfaces(const RenderOptions& options, const SceneView& scene, const Camera& camera) {
  Painter painter(options);
  return draw(painter, scene, camera, kVisible);
}

class RealMeshes : public testing::TestWithParam<const char*> {};

// Hours on two cores, so only `./dev check --full` runs it.
TEST_P(RealMeshes, EqualSerialAtEverySizeAndPoint) {
  if (!is_full()) GTEST_SKIP() << kOnlyFull;
  const std::filesystem::path file = shared_data(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Scene scene = io::read_scene(file);
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  constexpr int kSizes[][2] = {{1, 1}, {64, 64}, {1920, 1080}, {4096, 4096}, {8192, 8192}};
  for (const auto& [width, height] : kSizes) {
    RenderOptions options({.width = width, .height = height});
    options.transparency.method = Transparency::none;  // which every point of the table draws
    options.device = Device::serial;
    const Frame expected = surfaces(options, binding.view(), camera);
    options.device = Device::threads;
    for (const TablePoint& point : table_points()) {
      options.rasterizer = point.rasterizer;
      options.visibility = point.visibility;
      EXPECT_TRUE(same_images(surfaces(options, binding.view(), camera), expected))
          << test_name(point) << " at " << width;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RealMeshes, testing::ValuesIn(kRealMeshes), name_of_file);

std::string name_of(const testing::TestParamInfo<TablePoint>& p) {
  return test_name(p.param);
}
INSTANTIATE_TEST_SUITE_P(Points, Table, testing::ValuesIn(table_points()), name_of);

}  // namespace
}  // namespace rastrum::test::table_test
