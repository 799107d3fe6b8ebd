// SPDX-License-Identifier: BSD-3-Clause
// Every point of the coverage × visibility table on a device draws the serial reference's bits.
// Each point is a test of its own, so that failures name the row. By their counters its rows do the
// same work as the host's rows of the same names. Uses the façade's --device cuda; this program has
// the device code on the CPU (CMakeLists.txt).
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>

#include "tests/support/device_frames.hpp"
#include "tests/support/family.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::cuda_family_test {
namespace {

RenderOptions options(int width, int height, Device device, const TablePoint& point) {
  RenderOptions o = device_options(width, height, device);
  o.rasterizer = point.rasterizer;
  o.visibility = point.visibility;
  return o;
}

std::vector<TablePoint> device_points() {
  std::vector<TablePoint> points = table_points();
  std::erase_if(points, [](const TablePoint& p) { return p.rasterizer == "grouped"; });
  return points;
}

/// Compares the frames, and checks that the counters add up.
testing::AssertionResult whole_and_same(const Frame& a, const Frame& b) {
  if (auto r = same_frame(a, b); !r) return r;
  return counts_add_up(a);
}

/// Compares the counters of the same meaning. `hashed` counts tables like the host only where the
/// host has one per frame, not per tile.
void expect_same_work(const FrameStats& device, const FrameStats& host, const TablePoint& point) {
  static constexpr std::string_view kSame[] = {"rows",
                                               "runs",
                                               "small",
                                               "large",
                                               "bins",
                                               "tile pairs",
                                               "fragments compared",
                                               "depth matches",
                                               "fragments materialized",
                                               "fragments hashed",
                                               "fragments shaded"};
  static constexpr std::string_view kTables[] = {"table slots", "table entries", "probes"};
  const bool owned = point.rasterizer == "tiled" || point.rasterizer == "hybrid";
  int compared = 0;
  for (const auto& [name, value] : host.counters) {
    if (std::ranges::count(kSame, name) == 0 && (owned || std::ranges::count(kTables, name) == 0))
      continue;
    // The device leaves out counters that the host has as 0.
    const auto found =
        std::ranges::find(device.counters, name, &std::pair<std::string, std::uint64_t>::first);
    EXPECT_EQ(found == device.counters.end() ? 0 : found->second, value) << name;
    ++compared;
  }
  EXPECT_GT(compared, 1);
}

class CudaTable : public CudaTest, public testing::WithParamInterface<TablePoint> {};

TEST_P(CudaTable, EqualsSerialAndDoesTheHostsWork) {
  constexpr int kSizes[][2] = {{64, 64}, {37, 53}, {1, 1}, {128, 96}};
  const int scenes = share_of(6);
  for (const auto& [width, height] : kSizes) {
    Painter serial(device_options(width, height, Device::serial));
    Painter host(options(width, height, Device::threads, GetParam()));
    Painter cuda(options(width, height, Device::cuda, GetParam()));
    for (int i = 0; i < scenes; ++i) {
      const auto seed = static_cast<std::uint64_t>(width * 1000000 + i);
      const GeneratedScene g = generate(seed, width, height);
      const Frame frame = draw(cuda, g.view(), g.camera);
      ASSERT_TRUE(whole_and_same(frame, draw(serial, g.view(), g.camera)))
          << "scene " << seed << " (" << g.kind << ")";
      EXPECT_EQ(frame.stats.rasterizer, GetParam().rasterizer);
      EXPECT_EQ(frame.stats.visibility, GetParam().visibility);
      EXPECT_EQ(frame.stats.device, Device::cuda);
      expect_same_work(frame.stats, draw(host, g.view(), g.camera).stats, GetParam());
    }
  }
}

/// From less than a pixel to the whole picture, some at one depth.
Scene soup(int triangles, int width, int height) {
  Random random(7);
  Mesh mesh;
  for (int t = 0; t < triangles; ++t) {
    const double size = t % 100 == 0 ? 300 : t % 7 == 0 ? 40 : random.real(0.3, 12);
    const double x = random.real(0, width), y = random.real(0, height);
    const bool flat = t % 5 == 0;
    for (int c = 0; c < 3; ++c)
      mesh.positions.push_back(at_pixel(x + random.real(-size, size), y + random.real(-size, size),
                                        flat ? 0.5 : random.real(0.1, 0.9), width, height));
  }
  return single(std::move(mesh));
}

// Uses bands, batches, and turns of rows, bins, blocks and fragments.
TEST_P(CudaTable, NothingFailsForSize) {
  const bool is_fast = GetParam().rasterizer == "binned" || GetParam().rasterizer == "hybrid";
  if (!is_fast && test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  constexpr int kWidth = 200, kHeight = 300, kTriangles = 4000;
  constexpr std::uint64_t kLimit = 4000000;
  const Viewed seen(soup(kTriangles, kWidth, kHeight), pixel_camera(kWidth, kHeight));
  Painter serial(device_options(kWidth, kHeight, Device::serial));
  const Frame expected = draw(serial, seen);
  RenderOptions o = options(kWidth, kHeight, Device::cuda, GetParam());
  Painter free(o);
  const Frame at_once = draw(free, seen);
  EXPECT_TRUE(whole_and_same(at_once, expected));
  EXPECT_EQ(counter(at_once.stats, "bands"), 1U);
  o.memory_limit = kLimit;
  Painter limited(o);
  const Frame in_turns = draw(limited, seen);
  EXPECT_TRUE(whole_and_same(in_turns, expected));
  EXPECT_GT(counter(in_turns.stats, "bands"), 1U);
  // The limit does not count the mesh or its copy.
  EXPECT_LE(in_turns.stats.peak_bytes, kLimit + std::uint64_t{kTriangles} * 3 * sizeof(Vec3));
  if (GetParam().visibility == "sorted") {
    const std::uint64_t sorts = counter(at_once.stats, "sorts");
    EXPECT_LE(sorts, 2U);
    // No pixel has two segments in a sort, so only one thread raises it.
    const std::uint64_t segments = counter(at_once.stats, "segments");
    EXPECT_LE(segments, sorts * at_once.stats.pixels_covered);
    if (sorts == 1) {
      EXPECT_EQ(segments, at_once.stats.pixels_covered);
    }
    EXPECT_GT(counter(in_turns.stats, "sorts"), 4 * counter(in_turns.stats, "bands"));
  }
}

// Points, lines and triangles of one vertex function, some behind the eye, wide or biased.
TEST_P(CudaTable, DrawsAllTopologies) {
  constexpr int kWidth = 90, kHeight = 61;
  Painter serial(device_options(kWidth, kHeight, Device::serial));
  Painter cuda(options(kWidth, kHeight, Device::cuda, GetParam()));
  constexpr Topology kTopologies[] = {Topology::points, Topology::lines, Topology::triangles};
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Random random(seed);
    std::vector<Vec4> clip;
    for (int i = 0; i < 40; ++i) {
      const double w = random.chance(0.1) ? -0.5 : random.real(0.1, 4);
      clip.push_back({static_cast<float>((2 * random.real(-8, kWidth + 8) / kWidth - 1) * w),
                      static_cast<float>((1 - 2 * random.real(-8, kHeight + 8) / kHeight) * w),
                      static_cast<float>(random.integer(0, 8) / 8.0 * w), static_cast<float>(w)});
    }
    const Program program(
        [&clip](std::uint32_t v) {
          return VertexOutput<Vec4>{clip[v], clip[v]};
        },
        [](const Vec4& v, const Fragment& f) {
          return Vec4{v.x, f.depth, static_cast<float>(f.vertex[0]), 1};
        });
    std::vector<std::vector<std::uint32_t>> indices(std::size(kTopologies));
    std::vector<raster::Draw> draws;
    for (std::size_t t = 0; t < std::size(kTopologies); ++t) {
      for (int i = 0; i < 15 * static_cast<int>(kTopologies[t]); ++i)
        indices[t].push_back(static_cast<std::uint32_t>(random.integer(0, 39)));
      raster::Draw& d = draws.emplace_back(program.draw(clip.size(), indices[t], kTopologies[t]));
      d.line_width = static_cast<float>(random.real(0.1, 9));
      d.point_size = static_cast<float>(random.real(0.1, 30));
      d.depth_bias = static_cast<float>(random.real(-0.3, 0.3));
    }
    const Frame expected = draw(serial, draws, program, nullptr);
    EXPECT_GT(expected.stats.pixels_covered, 200U);
    ASSERT_TRUE(whole_and_same(draw(cuda, draws, program, nullptr), expected)) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Points, CudaTable, testing::ValuesIn(device_points()),
                         [](const auto& p) { return test_name(p.param); });

class CudaRows : public CudaTable {};

// The host's sizes of bins and tiles, orders and ways of small triangles work too.
TEST_P(CudaRows, TuningsAreTheHosts) {
  constexpr int kWidth = 300, kHeight = 140;
  const Viewed seen(soup(1500, kWidth, kHeight), pixel_camera(kWidth, kHeight));
  Painter serial(device_options(kWidth, kHeight, Device::serial));
  const Frame expected = draw(serial, seen);
  const bool binned = GetParam().rasterizer == "binned";
  const family::Tuning tunings[] = {
      {.bin_px = binned ? 32 : 16, .tile_px = binned ? 8 : 4, .small_px = 20},
      {.bin_px = 64, .tile_px = 16, .order = family::BlockOrder::morton},
      {.bin_px = 128, .tile_px = 8, .large_px = 500},
      {.large_px = 1, .small_path = family::SmallPath::rows}};
  for (const family::Tuning& tuning : tunings) {
    RenderOptions o = options(kWidth, kHeight, Device::cuda, GetParam());
    o.tuning = tuning;
    Painter cuda(o), host(by(o, Device::threads));
    const Frame frame = draw(cuda, seen);
    ASSERT_TRUE(whole_and_same(frame, expected)) << tuning.bin_px << '/' << tuning.tile_px;
    const Frame on_host = draw(host, seen);
    expect_same_work(frame.stats, on_host.stats, GetParam());
    if (binned) {
      EXPECT_EQ(counter(frame.stats, "batches"), counter(on_host.stats, "batches"));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Rows, CudaRows,
                         testing::Values(TablePoint{"scanline", "sorted"},
                                         TablePoint{"pineda", "sorted"},
                                         TablePoint{"tiled", "sorted"},
                                         TablePoint{"hybrid", "sorted"},
                                         TablePoint{"binned", "sorted"}),
                         [](const auto& p) { return p.param.rasterizer; });

using CudaChoice = CudaTest;

TEST_F(CudaChoice, NamesWhatTheDeviceHas) {
  const auto refused = [](const std::string& what, const TablePoint& point, int bin_px = 0) {
    RenderOptions o = options(8, 8, Device::cuda, point);
    o.tuning.bin_px = bin_px;
    expect_refused(what, [&] { const Painter painter(o); });
  };
  refused("by-size draws by 'atomic'", {"by-size", "sorted"});
  refused("by-size, grouped, scanline", {"scanlines", "auto"});
  refused("auto, atomic, search", {"auto", "nearest"});
  refused("bins/tiles of 48/8 px are not", {"tiled", "auto"}, 48);
}

TEST_F(CudaChoice, SaysWhatItTook) {
  const Viewed seen(soup(200, 64, 64), pixel_camera(64, 64));
  const auto stats_of = [&](const RenderOptions& o) {
    Painter renderer(o);
    return draw(renderer, seen).stats;
  };
  const FrameStats by_size = stats_of(device_options(64, 64, Device::cuda));
  EXPECT_EQ(by_size.rasterizer, "by-size");
  EXPECT_TRUE(holds(by_size.why, "cuda has by-size"));
  const FrameStats hybrid = stats_of(options(64, 64, Device::cuda, {"auto", "hashed"}));
  EXPECT_EQ(hybrid.rasterizer, "hybrid");
  EXPECT_EQ(hybrid.visibility, "hashed");
  EXPECT_TRUE(holds(hybrid.why, "auto takes hybrid"));
  const FrameStats grouped = stats_of(options(64, 64, Device::cuda, {"grouped", "auto"}));
  EXPECT_EQ(grouped.device, Device::threads);
  EXPECT_EQ(grouped.rasterizer, "grouped");
  EXPECT_TRUE(holds(grouped.device_why, "only the CPU has 'grouped'"));
  RenderOptions o = options(64, 64, Device::cuda, {"binned", "auto"});
  o.tuning.schedule = family::Schedule::persistent;
  EXPECT_TRUE(holds(stats_of(o).device_why, "persistent"));
}

// Translucent pieces go to the layers in every row. Any other visibility is refused.
TEST_F(CudaChoice, LayersCombineWithTheRows) {
  constexpr int kSize = 64;
  const Viewed seen(soup(150, kSize, kSize), pixel_camera(kSize, kSize));
  RenderOptions o = device_options(kSize, kSize, Device::threads);
  o.opacity = 0.5F;
  Painter threads(o);
  const LayerPicture expected = take(threads, seen);
  o.device = Device::cuda;
  for (const char* rasterizer : {"tiled", "scanline"}) {
    o.rasterizer = rasterizer;
    Painter cuda(o);
    const LayerPicture picture = take(cuda, seen);
    expect_by_device(picture, expected);
    EXPECT_EQ(picture.stats.rasterizer, rasterizer);
  }
  o.visibility = "sorted";
  Painter with_visibility(o);
  EXPECT_THROW((void)take(with_visibility, seen), Error);
}

}  // namespace
}  // namespace rastrum::test::cuda_family_test
