// What `rastrum bench` does with its arguments, and how scenes and sizes are chosen.
#include <bench/bench.hpp>
#include <bench/peers/selection.hpp>
#include <bench/registry.hpp>
#include <bench/scenes.hpp>

#include <set>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/error.hpp>

namespace rastrum::bench {
namespace {

int run_with(std::vector<std::string_view> args) {
  return run(args);
}

TEST(Run, ListsAndRefuses) {
  EXPECT_EQ(run_with({}), 0);
  EXPECT_EQ(run_with({"--help"}), 0);
  EXPECT_EQ(run_with({"no-such-benchmark"}), 2);
}

TEST(Run, EveryBenchmarkExplainsItselfAndRefusesUnknownOptions) {
  std::set<std::string_view> names;
  for (const Benchmark& b : benchmarks()) {
    EXPECT_TRUE(names.insert(b.name).second) << b.name << " is there twice";
    EXPECT_EQ(run_with({b.name, "--help"}), 0) << b.name;
    EXPECT_EQ(run_with({b.name, "--no-such-option"}), 2) << b.name;
  }
}

TEST(Selection, ParsesSizes) {
  const Size size = parse_size("1920x1080");
  EXPECT_EQ(size.width, 1920);
  EXPECT_EQ(size.height, 1080);
  EXPECT_EQ(size_text(size), "1920x1080");
  for (const char* bad : {"", "x", "12", "12x", "x12", "0x5", "-1x5", "12x12x", "12 x 12"})
    EXPECT_THROW(static_cast<void>(parse_size(bad)), Error) << bad;
}

TEST(Scenes, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const SceneInfo& scene : peer_scenes()) EXPECT_TRUE(names.insert(scene.name).second);
  EXPECT_EQ(scene_by_name("brain").file, "big/brain_iso126_1033k.ply");
  EXPECT_THROW(static_cast<void>(scene_by_name("no-such-scene")), Error);
}

TEST(Scenes, ShapesComeWithSharedNormals) {
  for (const SceneInfo& scene : procedural_scenes()) {
    ASSERT_TRUE(available(scene)) << scene.name;
    const Mesh mesh = load(scene);
    EXPECT_GT(mesh.triangle_count(), 1000U) << scene.name;
    EXPECT_EQ(mesh.normals.values.size(), mesh.positions.size()) << scene.name;
    EXPECT_TRUE(mesh.normals.indices.empty()) << scene.name;
  }
}

}  // namespace
}  // namespace rastrum::bench
