// SPDX-License-Identifier: BSD-3-Clause
// The arguments of `rastrum bench`, and the choice of scenes and sizes.
#include <bench/bench.hpp>
#include <bench/peers/selection.hpp>
#include <bench/registry.hpp>
#include <bench/scenes.hpp>

#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

namespace rastrum::bench::run_test {
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

TEST(Selection, ShapesStandInBesideThoseAskedForWhereNoFileIsHere) {
  const char* const shared = std::getenv("RASTRUM_SHARED");
  const std::string before = shared != nullptr ? shared : "";
  setenv("RASTRUM_SHARED", "/no-such-folder", 1);
  Selection selection(transparency_scenes(), {{64, 64}});
  selection.resolve();
  // One of these is a shape already and must not be added twice.
  Selection peers(peer_scenes(), {{64, 64}});
  peers.resolve();
  if (shared != nullptr)
    setenv("RASTRUM_SHARED", before.c_str(), 1);
  else
    unsetenv("RASTRUM_SHARED");
  std::set<std::string_view> names, absent;
  for (const SceneInfo& scene : selection.scenes())
    EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
  for (const SceneInfo& scene : selection.absent()) absent.insert(scene.name);
  for (const char* name : {"boxes", "hairball", "gyroid"})
    EXPECT_TRUE(names.contains(name)) << name;
  for (const char* name : {"pine", "bunny", "brain"}) EXPECT_TRUE(absent.contains(name)) << name;
  EXPECT_EQ(absent.size() + 2, transparency_scenes().size());
  names.clear();
  for (const SceneInfo& scene : peers.scenes())
    EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
  EXPECT_EQ(names.size(), procedural_scenes().size());
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
}  // namespace rastrum::bench::run_test
