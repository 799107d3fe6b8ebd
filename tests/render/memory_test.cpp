// SPDX-License-Identifier: BSD-3-Clause
// The memory limit: a frame's scratch stays within it for every point of the coverage × visibility
// table, on much larger scenes, and the picture does not change. A limit that is too low is refused
// with the least possible one. Also tests the memory of `sorted` per fragment.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/family.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::memory_test {
namespace {

/// A mesh and a picture that together take many times `limit`.
struct Load {
  std::string name;
  Mesh mesh;
  int width, height;
  std::vector<std::uint64_t> limits;
};

/// `count` triangles that fill the picture, at depths in random order.
Mesh layers(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float z = static_cast<float>(i * 7 % count) / static_cast<float>(count);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{-3, -1, z}, {3, -1, z}, {0, 4, z}});
    mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
  }
  return mesh;
}

constexpr std::uint64_t kMebi = std::uint64_t{1} << 20;

std::vector<Load> loads() {
  const auto large = shapes::soup(is_full() ? 1000000 : 30000, 0.01F, 0.05F);
  if (is_full())
    return {{"many triangles", large, 2048, 2048, {8 * kMebi, 64 * kMebi}},
            {"many pixels", layers(12), 8192, 8192, {48 * kMebi, 256 * kMebi}},
            {"many layers", layers(2000), 512, 512, {8 * kMebi, 64 * kMebi}}};
  return {{"many triangles", large, 400, 300, {5 * kMebi, 16 * kMebi}},
          {"many pixels", layers(4), 1500, 500, {12 * kMebi}},
          {"many layers", layers(120), 200, 150, {5 * kMebi}}};
}

Camera straight_on() {
  return Camera{.eye = {0, 0, 3}, .target = {0, 0, 0}};
}

/// Every image but overdraw, which turns hierarchical Z off.
constexpr unsigned kKinds = kColor8 | kVisible;
Frame picture(Painter& renderer, const SceneView& scene) {
  return draw(renderer, scene, straight_on(), kKinds);
}

RenderOptions options(const TablePoint& point, int width, int height, int threads) {
  return RenderOptions({.width = width, .height = height, .shader = Shader::normal},
                       {.threads = threads}, point);
}

class MemoryLimit : public testing::TestWithParam<TablePoint> {};

TEST_P(MemoryLimit, IsKeptAndChangesNoPixel) {
  for (const Load& load : loads()) {
    const OneInstance scene(load.mesh.view());
    const Frame expected = draw(options({"auto", "auto"}, load.width, load.height, 2), scene.view(),
                                straight_on(), kKinds);
    ASSERT_GT(expected.stats.pixels_covered, 1000U);
    for (const std::uint64_t limit : load.limits) {
      for (const int threads : {2, 8}) {
        if (threads == 8 && limit != load.limits.front()) continue;
        RenderOptions o = options(GetParam(), load.width, load.height, threads);
        o.memory_limit = limit;
        Painter renderer(o);
        // The second frame starts with what the first one kept.
        for (int frame = 0; frame < 2; ++frame) {
          const Frame limited = picture(renderer, scene.view());
          ASSERT_TRUE(same_images(limited, expected)) << load.name << ", " << limit;
          EXPECT_LE(limited.stats.peak_bytes, limit)
              << load.name << ", " << threads << " threads, frame " << frame;
        }
      }
    }
  }
}

/// The number N in "… is less than the N that this frame needs at least"; 0 if there is none.
template <class F>
std::uint64_t least_for(const F& frame_of_1000_bytes) {
  const std::string said = refusal_of(frame_of_1000_bytes, Errc::out_of_memory);
  EXPECT_TRUE(holds(said, "1000 bytes"));
  const std::size_t at = said.find("less than the ");
  return at == std::string::npos ? 0 : std::stoull(said.substr(at + 14));
}

TEST_P(MemoryLimit, SaysTheLeastOneWhereItIsTooSmall) {
  const Load load = loads().back();
  const OneInstance scene(load.mesh.view());
  const auto limited_to = [&](std::uint64_t limit) {
    RenderOptions o = options(GetParam(), load.width, load.height, 2);
    o.memory_limit = limit;
    return draw(o, scene.view(), straight_on(), kKinds);
  };
  const Frame expected = limited_to(0);
  const std::uint64_t least = least_for([&] { limited_to(1000); });
  EXPECT_THROW(limited_to(least - 1), Error);
  const Frame limited = limited_to(least);
  EXPECT_TRUE(same_images(limited, expected));
  EXPECT_LE(limited.stats.peak_bytes, least);
}

INSTANTIATE_TEST_SUITE_P(Points, MemoryLimit, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

/// Tests the least limit and a slightly larger one, for one renderer's frames with several samples,
/// opaque and in layers.
TEST(MemoryLimitOfSamples, IsKeptAndChangesNoPixel) {
  struct Named {
    const char* name;
    Mesh mesh;
  };
  const Named meshes[] = {{"few large", layers(24)},
                          {"many large", layers(share_of(300, 80))},
                          {"small", shapes::soup(share_of(5000, 500), 0.01F, 0.05F)}};
  for (const auto& [name, mesh] : meshes)
    for (const float opacity : {1.0F, 0.4F})
      for (int samples = test_share() < 100 ? 16 : 4; samples <= 16; samples *= 4)
        for (const int threads : {1, 2}) {
          OneInstance instance(mesh.view());
          instance.opacity = opacity;
          const auto limited_to = [&](std::uint64_t limit) {
            return draw({.memory_limit = limit, .threads = threads}, instance.view(), straight_on(),
                        {.width = 100, .height = 70, .shader = Shader::phong, .samples = samples},
                        kColor);
          };
          const Frame want = limited_to(0);
          const std::uint64_t least = least_for([&] { limited_to(1000); });
          ASSERT_GT(least, 0U);
          for (const std::uint64_t limit : {least, least * 3 / 2}) {
            const std::string what = std::string(name) + ", " + std::to_string(samples) +
                                     " samples, opacity " + std::to_string(opacity) + ", " +
                                     std::to_string(threads) + " threads";
            try {
              const Frame got = limited_to(limit);
              EXPECT_LE(got.stats.peak_bytes, limit) << what;
              EXPECT_TRUE(same_images(got, want)) << what;
            } catch (const Error& e) {
              // A bin of 64² px needs all of its memory at once.
              EXPECT_EQ(e.code(), Errc::out_of_memory) << what;
            }
          }
        }
}

class SortedMemory : public testing::TestWithParam<std::string> {};

// Paper 5: 51 bytes a fragment.
TEST_P(SortedMemory, IsAtMost24BytesAFragment) {
  const Mesh mesh = layers(40);
  const OneInstance scene(mesh.view());
  Painter atomic(options({GetParam(), "atomic"}, 512, 512, 2));
  Painter sorted(options({GetParam(), "sorted"}, 512, 512, 2));
  std::uint64_t fragments = 0, beside = 0, with = 0;
  for (int frame = 0; frame < 2; ++frame) {
    const FrameStats a = picture(atomic, scene.view()).stats;
    const FrameStats s = picture(sorted, scene.view()).stats;
    fragments = s.fragments;
    beside = a.peak_bytes;
    with = s.peak_bytes;
    EXPECT_GT(fragments, 5000000U);
    EXPECT_LE(with - std::min(with, beside), 24 * fragments) << frame;
  }
  RecordProperty("bytes_a_fragment_x100",
                 std::to_string((with - std::min(with, beside)) * 100 / fragments));
}

std::vector<std::string> coverage_names() {
  std::vector<std::string> names;
  for (const family::AxisInfo& r : family::rasterizer_axis())
    if (r.name != "reference") names.push_back(r.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Coverages, SortedMemory, testing::ValuesIn(coverage_names()),
                         [](const auto& p) { return p.param; });

}  // namespace
}  // namespace rastrum::test::memory_test
