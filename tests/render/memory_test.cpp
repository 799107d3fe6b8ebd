// The memory limit: a frame's scratch stays at or below it for every point of the coverage ×
// visibility table, on scenes that are far larger, and the picture is the one without a limit. A
// limit that cannot be honoured is refused with the least one that can. The memory that `sorted`
// takes for a fragment is tested, too.
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
#include "tests/support/painter.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::memory_test {
namespace {

/// A mesh in a picture, which together take many times `limit`.
struct Load {
  std::string name;
  Mesh mesh;
  int width, height;
  std::vector<std::uint64_t> limits;
};

/// `count` triangles that fill the picture, at depths in no order.
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
  std::vector<Load> all;
  if (is_full()) {
    all.push_back({"many triangles",
                   shapes::soup(1000000, 0.01F, 0.05F),
                   2048,
                   2048,
                   {8 * kMebi, 64 * kMebi}});
    all.push_back({"many pixels", layers(12), 8192, 8192, {48 * kMebi, 256 * kMebi}});
    all.push_back({"many layers", layers(2000), 512, 512, {8 * kMebi, 64 * kMebi}});
    return all;
  }
  all.push_back(
      {"many triangles", shapes::soup(30000, 0.01F, 0.05F), 400, 300, {5 * kMebi, 16 * kMebi}});
  all.push_back({"many pixels", layers(4), 1500, 500, {12 * kMebi}});
  all.push_back({"many layers", layers(120), 200, 150, {5 * kMebi}});
  return all;
}

Camera straight_on() {
  return Camera{.eye = {0, 0, 3}, .target = {0, 0, 0}};
}

/// Every image but the overdraw, which turns hierarchical Z off.
constexpr unsigned kKinds = kColor8 | kVisible;
Frame picture(Painter& renderer, const SceneView& scene) {
  return draw(renderer, scene, straight_on(), kKinds);
}

RenderOptions options(const TablePoint& point, int width, int height, int threads) {
  return RenderOptions({.width = width, .height = height, .shader = Shader::normal},
                       {.threads = threads},
                       {.rasterizer = point.rasterizer, .visibility = point.visibility});
}

class MemoryLimit : public testing::TestWithParam<TablePoint> {};

TEST_P(MemoryLimit, IsKeptAndChangesNoPixel) {
  for (const Load& load : loads()) {
    const Scene scene = single(load.mesh);
    const SceneBinding binding(scene);
    Painter free(options({"auto", "auto"}, load.width, load.height, 2));
    const Frame expected = picture(free, binding.view());
    ASSERT_GT(expected.stats.pixels_covered, 1000U);
    for (const std::uint64_t limit : load.limits) {
      for (const int threads : {2, 8}) {
        if (threads == 8 && limit != load.limits.front()) continue;
        RenderOptions o = options(GetParam(), load.width, load.height, threads);
        o.memory_limit = limit;
        Painter renderer(o);
        // A second frame has what the first one kept.
        for (int frame = 0; frame < 2; ++frame) {
          const Frame limited = picture(renderer, binding.view());
          ASSERT_TRUE(same_images(limited, expected)) << load.name << ", " << limit;
          EXPECT_LE(limited.stats.peak_bytes, limit)
              << load.name << ", " << threads << " threads, frame " << frame;
        }
      }
    }
  }
}

/// The number in "… is less than the N that this frame needs at least".
std::uint64_t least_in(const std::string& message) {
  const std::size_t at = message.find("less than the ");
  return at == std::string::npos ? 0 : std::stoull(message.substr(at + 14));
}

TEST_P(MemoryLimit, SaysTheLeastOneWhereItIsTooSmall) {
  const Load load = loads().back();
  const Scene scene = single(load.mesh);
  const SceneBinding binding(scene);
  RenderOptions o = options(GetParam(), load.width, load.height, 2);
  Painter free(o);
  const Frame expected = picture(free, binding.view());
  o.memory_limit = 1000;
  std::uint64_t least = 0;
  try {
    Painter renderer(o);
    picture(renderer, binding.view());
    FAIL() << "1000 bytes were enough";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::out_of_memory);
    EXPECT_NE(std::string(e.what()).find("1000 bytes"), std::string::npos) << e.what();
    least = least_in(e.what());
  }
  o.memory_limit = least - 1;
  {
    Painter renderer(o);
    EXPECT_THROW(picture(renderer, binding.view()), Error);
  }
  o.memory_limit = least;
  Painter renderer(o);
  const Frame limited = picture(renderer, binding.view());
  EXPECT_TRUE(same_images(limited, expected));
  EXPECT_LE(limited.stats.peak_bytes, least);
}

INSTANTIATE_TEST_SUITE_P(Points, MemoryLimit, testing::ValuesIn(table_points()),
                         [](const auto& p) { return test_name(p.param); });

/// A limit that is somewhat more than the least, and the least, of one renderer's frames with
/// several samples, opaque and in layers.
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
          InstanceView instance{mesh.view()};
          instance.opacity = opacity;
          const SceneView scene{{&instance, 1}};
          FrameOptions frame{
              .width = 100, .height = 70, .shader = Shader::phong, .samples = samples};
          const auto draw = [&](std::uint64_t limit, Image<Vec4>& color) {
            Renderer renderer({.memory_limit = limit, .threads = threads});
            return renderer.render(scene, straight_on(), frame, {.color = color}).peak_bytes;
          };
          Image<Vec4> want(frame.width, frame.height), color(frame.width, frame.height);
          (void)draw(0, want);
          std::uint64_t least = 0;
          try {
            (void)draw(1000, color);
          } catch (const Error& e) {
            least = least_in(e.what());
          }
          ASSERT_GT(least, 0U);
          for (const std::uint64_t limit : {least, least * 3 / 2}) {
            const std::string what = std::string(name) + ", " + std::to_string(samples) +
                                     " samples, opacity " + std::to_string(opacity) + ", " +
                                     std::to_string(threads) + " threads";
            try {
              EXPECT_LE(draw(limit, color), limit) << what;
              EXPECT_TRUE(std::ranges::equal(color.pixels(), want.pixels())) << what;
            } catch (const Error& e) {
              // All memory of a bin of 64² px is needed at once.
              EXPECT_EQ(e.code(), Errc::out_of_memory) << what;
            }
          }
        }
}

class SortedMemory : public testing::TestWithParam<std::string> {};

// Paper 5: 51 bytes a fragment.
TEST_P(SortedMemory, IsAtMost24BytesAFragment) {
  const Scene scene = single(layers(40));
  const SceneBinding binding(scene);
  Painter atomic(options({GetParam(), "atomic"}, 512, 512, 2));
  Painter sorted(options({GetParam(), "sorted"}, 512, 512, 2));
  std::uint64_t fragments = 0, beside = 0, with = 0;
  for (int frame = 0; frame < 2; ++frame) {
    const FrameStats a = picture(atomic, binding.view()).stats;
    const FrameStats s = picture(sorted, binding.view()).stats;
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
