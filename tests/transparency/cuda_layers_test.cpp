// SPDX-License-Identifier: BSD-3-Clause
// Layers on a device equal the host's scalar path: the same order and bits of every colour, in each
// tier and with any budget. Without a GPU the device is the CPU (CMakeLists.txt), with the code for
// nvcc.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/render.hpp>
#include <rastrum/transparency/cuda/device_layers.hpp>

#include "tests/cuda/layers_on_device.hpp"
#include "tests/support/layer_picture.hpp"
#include "tests/support/layer_program.hpp"
#include "tests/support/layer_scenes.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/test_share.hpp"

#if !defined(RASTRUM_TEST_DEVICE_WORDS)
#include <rastrum/parallel/cuda/status.hpp>
#else
#include <rastrum/parallel/cuda/host_stream.hpp>
#include <rastrum/raster/draws/numbering.hpp>
#endif

namespace rastrum::test::cuda_layers_test {
namespace {

using transparency::DeviceLayerCounts;
using transparency::DeviceLayerTuning;

/// Pieces from the host's setup, and the opaque surface.
LayersFrame frame_of(const LayerScene& scene, LayerProgram& program, int width, int height) {
  LayersFrame f;
  f.width = width;
  f.height = height;
  f.paint = scene.colors;
  f.opaque = scene.opaque;
  f.by_pixel = scene.paint == Paint::pixel;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  f.keys.assign(pixels, 0);
  f.colors.assign(pixels, {});
  const std::span<raster::Draw> draws = program.draws();
  const raster::Totals totals = raster::number_draws(draws);
  const raster::FrameGeometry geometry{width, height, raster::Viewport::of(width, height), draws,
                                       nullptr};
  std::vector<raster::ProjectedVertex> projected(totals.vertices);
  raster::FrameGeometry whole = geometry;
  for (const raster::Draw& draw : draws)
    draw.source.project(0, draw.vertex_count, geometry.viewport, Isa::scalar,
                        projected.data() + draw.first_vertex);
  whole.projected = projected.data();
  for (const raster::Draw& draw : draws)
    for (std::uint64_t p = 0; p < draw.primitive_count; ++p)
      static_cast<void>(raster::assemble_primitive(
          whole, draw, p, [&](const raster::Piece& piece) { f.pieces.push_back(piece); }));
  for (const raster::Piece& piece : f.pieces) {
    if ((piece.flags & kTranslucent) != 0) continue;
    const raster::Rect box = raster::piece_bounds(piece, {0, 0, width, height});
    for (int y = box.y0; y < box.y1; ++y) {
      const raster::Span span = raster::row_span(piece, y, box.x0, box.x1);
      for (int x = span.begin; x < span.end; ++x) {
        const std::uint64_t id = raster::kIdMask - piece.low;
        if (scene.is_hole(id, x, y)) continue;
        const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x);
        const std::uint64_t key = raster::make_key(raster::depth_at(piece, x, y), piece.low);
        if (key <= f.keys[i]) continue;
        f.keys[i] = key;
        f.colors[i] =
            f.by_pixel ? scene.pixel_color(id, x, y) : scene.colors[static_cast<std::size_t>(id)];
      }
    }
  }
  return f;
}

/// A generated scene that layers_on_device.cu's functors can colour.
LayerScene scene_of(std::uint64_t seed, int width, int height, int most_fragments) {
  LayerScene scene = generate_layers(seed, width, height, most_fragments);
  if (scene.paint == Paint::gradient) scene.paint = Paint::triangle;
  return scene;
}

testing::AssertionResult equals_host(const LayersFrame& f, const LayerPicture& host) {
  Frame on_device(f.width, f.height, kColor | kVisible);
  for (std::size_t i = 0; i < f.keys.size(); ++i) {
    const std::uint64_t key = f.keys[i];
    on_device.ids.pixels()[i] = key == 0 ? -1 : static_cast<std::int64_t>(raster::id_of_key(key));
    on_device.depth.pixels()[i] =
        std::bit_cast<float>(static_cast<std::uint32_t>(key >> raster::kIdBits));
    on_device.color.pixels()[i] = f.colors[i];
  }
  return same_images(on_device, host, kColor | kVisible);
}

RenderOptions host_options(int width, int height, Device device,
                           const TransparencyOptions& method = {}) {
  return RenderOptions(
      {.width = width, .height = height, .background = {0, 0, 0, 0}, .transparency = method},
      {.device = device, .threads = 2, .isa = Isa::scalar});
}

struct Way {
  const char* name;
  DeviceLayerTuning tuning;
  int band_rows = 0;
};

class CudaLayers : public testing::Test {
 protected:
  /// Blends `start` in that way and expects the host's bits.
  static DeviceLayerCounts expect_host(LayersFrame start, const LayerPicture& host, const Way& way,
                                       const TransparencyOptions& options = {}) {
    const DeviceLayerCounts counts = blend_on_device(start, options, way.tuning, way.band_rows);
    EXPECT_TRUE(equals_host(start, host)) << way.name << ", threshold " << options.alpha_threshold;
    return counts;
  }
  void SetUp() override {
#if !defined(RASTRUM_TEST_DEVICE_WORDS)
    const parallel::CudaStatus status = parallel::cuda_status();
    if (!status.usable) GTEST_SKIP() << "no device: " << status.why_not;
#else
    parallel::cuda_system::HostStream::be_late(true);
#endif
  }
};

/// Each tier alone, all at once, budgets that need many turns, and bands.
const Way kWays[] = {
    {"as it is", {}},
    {"high density alone", {0, 2048, 0}},
    {"deep alone", {0, 0, 0}},
    {"three tiers", {3, 9, 0}},
    {"4 KiB", {3, 9, 4096}},
    {"no bytes", {256, 2048, 1}},
    {"bands", {3, 9, 4096}, 16},
};
const int kSizes[][2] = {{1, 1}, {17, 5}, {37, 53}, {64, 64}, {100, 20}};

int scene_count() {
  return share_of(50, kLayerKinds);
}

TEST_F(CudaLayers, EqualTheHostInEveryTierAndBudget) {
  DeviceLayerCounts all;
  int counted = 0;
  for (const auto& [width, height] : kSizes)
    for (int i = 0; i < scene_count(); ++i) {
      const std::uint64_t seed = static_cast<std::uint64_t>(i + 7919 * width);
      const LayerScene scene = scene_of(seed, width, height, 100000);
      SCOPED_TRACE("scene " + std::to_string(seed) + " (" + scene.kind + ")");
      LayerProgram program(scene, width, height);
      Painter renderer(host_options(width, height, i % 4 == 0 ? Device::serial : Device::threads));
      const LayerPicture host = take(renderer, program);
      const LayersFrame start = frame_of(scene, program, width, height);
      for (const Way& way : kWays) {
        const DeviceLayerCounts counts = expect_host(start, host, way);
        if (HasFailure()) return;
        if (host.stats.rasterizer != "reference" && host.stats.visibility == "layers") {
          ++counted;
          EXPECT_EQ(counts.fragments, host.counter("translucent fragments")) << way.name;
          EXPECT_EQ(counts.deepest, host.counter("deepest")) << way.name;
        }
        all.add(counts);
        if (way.tuning.bytes == 1) {
          // A turn holds one block, and empty ones beside it.
          EXPECT_GE(counts.turns, counts.low_blocks + counts.high_blocks + counts.deep_blocks);
        }
      }
    }
  EXPECT_GT(counted, 0);
  if (scene_count() > kLayerKinds) {
    EXPECT_GE(all.deepest, 1000U);
  }
  EXPECT_GT(all.repaired, 0U);
  EXPECT_GT(all.low_blocks, 0U);
  EXPECT_GT(all.high_blocks, 0U);
  EXPECT_GT(all.deep_blocks, 0U);
}

/// The number of pixels that two pieces of one triangle cover.
int pixels_covered_twice(const LayersFrame& f) {
  int count = 0;
  for (std::size_t i = 0; i + 1 < f.pieces.size(); ++i)
    for (std::size_t k = i + 1; k < f.pieces.size() && f.pieces[k].low == f.pieces[i].low; ++k) {
      const raster::Rect box = raster::piece_bounds(f.pieces[i], {0, 0, f.width, f.height});
      for (int y = box.y0; y < box.y1; ++y) {
        const raster::Span a = raster::row_span(f.pieces[i], y, 0, f.width);
        const raster::Span b = raster::row_span(f.pieces[k], y, 0, f.width);
        count += std::max(0, std::min(a.end, b.end) - std::max(a.begin, b.begin));
      }
    }
  return count;
}

// Pieces of a clipped triangle may overlap by a snapped vertex; they are one layer.
TEST_F(CudaLayers, OverlappingPiecesOfAClippedTriangleAreOneLayer) {
  const int size = 64;
  const LayerScene scene = overlapping_pieces();
  LayerProgram program(scene, size, size);
  const LayersFrame start = frame_of(scene, program, size, size);
  ASSERT_GE(pixels_covered_twice(start), static_cast<int>(scene.size()));
  for (const Transparency method : {Transparency::exact, Transparency::unsorted}) {
    TransparencyOptions options{.method = method};
    Painter renderer(host_options(size, size, Device::threads, options));
    const LayerPicture host = take(renderer, program);
    for (const Way& way : kWays) {
      const DeviceLayerCounts counts = expect_host(start, host, way, options);
      EXPECT_EQ(counts.fragments, host.counter("translucent fragments")) << way.name;
    }
  }
}

TEST_F(CudaLayers, UnsortedAndThresholdsEqualTheHost) {
  TransparencyOptions unsorted, paper, early;
  unsorted.method = Transparency::unsorted;
  paper.alpha_threshold = 1 - 1.0F / 128;
  early.alpha_threshold = 0.5F;
  const int width = 37, height = 21;
  for (const TransparencyOptions& method : {unsorted, paper, early}) {
    for (int i = 0; i < 2 * kLayerKinds; ++i) {
      const LayerScene scene = scene_of(static_cast<std::uint64_t>(i), width, height, 30000);
      SCOPED_TRACE(scene.kind);
      LayerProgram program(scene, width, height);
      Painter renderer(host_options(width, height, Device::serial, method));
      const LayerPicture host = take(renderer, program);
      const LayersFrame start = frame_of(scene, program, width, height);
      for (const Way& way : kWays) expect_host(start, host, way, method);
      if (HasFailure()) return;
    }
  }
}

// Two thousand layers a pixel in random order, more than shared memory holds.
TEST_F(CudaLayers, DeepStacksGoThroughTheDevicesMemory) {
  const int size = 16;
  const LayerScene scene = layer_stack(5, 2000, 0.01, size, size);
  LayerProgram program(scene, size, size);
  Painter renderer(host_options(size, size, Device::threads));
  const LayerPicture host = take(renderer, program);
  for (const std::uint64_t bytes : {std::uint64_t{0}, std::uint64_t{1} << 16}) {
    LayersFrame f = frame_of(scene, program, size, size);
    const DeviceLayerCounts counts = blend_on_device(f, {}, {256, 2048, bytes});
    EXPECT_TRUE(equals_host(f, host));
    EXPECT_EQ(counts.deepest, 2000U);
    EXPECT_EQ(counts.fragments, 2000U * size * size);
    EXPECT_GT(counts.deep_blocks, 0U);
    EXPECT_EQ(counts.turns, bytes == 0 ? 1U : 4U);
  }
}

// The order of the records leaves no trace in picture and counts.
TEST_F(CudaLayers, OrderOfPiecesDoesNotMatter) {
  const int width = 40, height = 40;
  Random r(3);
  for (int i = 0; i < kLayerKinds; ++i) {
    const LayerScene scene = scene_of(static_cast<std::uint64_t>(i), width, height, 30000);
    SCOPED_TRACE(scene.kind);
    LayerProgram program(scene, width, height);
    LayersFrame a = frame_of(scene, program, width, height), b = a;
    for (std::size_t k = b.pieces.size(); k > 1; --k)
      std::swap(b.pieces[k - 1],
                b.pieces[static_cast<std::size_t>(r.integer(0, static_cast<int>(k) - 1))]);
    for (const Transparency method : {Transparency::exact, Transparency::unsorted}) {
      TransparencyOptions options{.method = method};
      LayersFrame x = a, y = b;
      const DeviceLayerCounts one = blend_on_device(x, options, {4, 64, 0});
      const DeviceLayerCounts other = blend_on_device(y, options, {4, 64, 0});
      EXPECT_EQ(x.keys, y.keys);
      EXPECT_EQ(one.fragments, other.fragments);
      EXPECT_EQ(one.records, other.records);
      EXPECT_EQ(x.colors, y.colors);
    }
  }
}

// A frame like the one before allocates no memory.
TEST_F(CudaLayers, ASteadyFrameAllocatesNothing) {
  const int size = 64;
  const LayerScene scene = scene_of(0, size, size, 100000);
  LayerProgram program(scene, size, size);
  EXPECT_EQ(growth_of_a_second_frame(frame_of(scene, program, size, size)), 0U);
}

// Queues and counters on the device, instead of sizes that the host waits for, give the listing's
// keys, colours and counts, whether or not all queues have room.
TEST_F(CudaLayers, QueuesEqualTheListing) {
  struct Room {
    const char* name;
    std::size_t pieces, records;
  };
  std::uint64_t listed = 0, queued = 0;
  DeviceLayerCounts all;
  TransparencyOptions unsorted;
  unsorted.method = Transparency::unsorted;
  for (const auto& [width, height, kinds] : {std::tuple{37, 53, kLayerKinds}, {300, 130, 2}})
    for (int i = 0; i < kinds; ++i) {
      const LayerScene scene = scene_of(static_cast<std::uint64_t>(i), width, height, 15000);
      SCOPED_TRACE(scene.kind);
      LayerProgram program(scene, width, height);
      const LayersFrame start = frame_of(scene, program, width, height);
      for (const TransparencyOptions& options : {TransparencyOptions{}, unsorted})
        for (const Way& way : {kWays[0], kWays[6]}) {
          if (way.band_rows != 0 && options.method == Transparency::unsorted) continue;
          LayersFrame expected = start;
          const DeviceLayerCounts counts =
              blend_on_device(expected, options, way.tuning, way.band_rows);
          for (const Room& room : {Room{"enough", 0, 0},
                                   {"of pieces", start.pieces.size() / 2 + 1, 0},
                                   {"of records", 0, 7}}) {
            LayersFrame f = start;
            const QueueRooms rooms{true, room.pieces, room.records};
            const DeviceLayerCounts c =
                blend_on_device(f, options, way.tuning, way.band_rows, rooms);
            ASSERT_EQ(f.keys, expected.keys) << way.name << ", " << room.name;
            ASSERT_EQ(std::memcmp(f.colors.data(), expected.colors.data(),
                                  f.colors.size() * sizeof(Vec4)),
                      0)
                << way.name << ", " << room.name;
            EXPECT_EQ(c.fragments, counts.fragments);
            EXPECT_EQ(c.deepest, counts.deepest);
            EXPECT_EQ(c.repaired, counts.repaired);
            EXPECT_EQ(c.records, counts.records);
            EXPECT_EQ(c.low_blocks, counts.low_blocks);
            EXPECT_EQ(c.high_blocks, counts.high_blocks);
            EXPECT_EQ(c.deep_blocks, counts.deep_blocks);
            listed += rooms.too_small;
            if (room.pieces + room.records == 0) {
              EXPECT_EQ(rooms.too_small, 0U);
              ++queued;
            }
          }
          all.add(counts);
        }
    }
  EXPECT_GT(listed, 0U);
  EXPECT_GT(queued, 0U);
  EXPECT_GT(all.deep_blocks, 0U);
  EXPECT_GT(all.high_blocks, 0U);
  EXPECT_GT(all.repaired, 0U);
}

TEST_F(CudaLayers, WhatADeviceDoesNotHaveIsRefused) {
  LayersFrame f;
  f.width = f.height = 8;
  f.keys.resize(64);
  f.colors.resize(64);
  TransparencyOptions options;
  EXPECT_EQ(transparency::why_not_on_a_device(options), "");
  for (const TransparencyOptions& method : {family::filtered(3), family::wboit(), family::mboit4(),
                                            family::mboit6(), family::mlab4()}) {
    options = method;
    EXPECT_NE(transparency::why_not_on_a_device(options), "");
    expect_refused("exact or unsorted",
                   [&] { static_cast<void>(blend_on_device(f, options, {})); });
  }
}

TEST_F(CudaLayers, TeamsSortAndSumUp) {
  Random r(1);
  // Up to 256 keys a team sorts in other ways than beyond.
  std::vector<std::size_t> sizes{100, 128, 129, 200, 255, 256, 257, 300, 513, 1000, kMostTeamKeys};
  for (std::size_t n = 0; n <= 65; ++n) sizes.push_back(n);
  for (const std::size_t n : sizes) {
    SCOPED_TRACE(n);
    std::vector<std::uint32_t> values(n);
    for (std::uint32_t& v : values)
      v = r.chance(0.1) ? 0xFFFFFFFFU : static_cast<std::uint32_t>(r.integer(0, 40));
    const TeamResult got = team_keys(values);
    std::vector<std::uint32_t> sorted = values, sums(n + 1, 0);
    std::ranges::sort(sorted);
    EXPECT_EQ(got.sorted, sorted);
    std::partial_sum(values.begin(), values.end(), sums.begin() + 1);
    EXPECT_EQ(got.sums, sums);
    // Values follow their keys. Equal keys may swap, the largest also with the padding.
    for (const auto* places : {&got.places, &got.order})
      for (std::size_t i = 0; i < n; ++i) {
        if (sorted[i] == 0xFFFFFFFFU) continue;
        ASSERT_LT((*places)[i], n);
        EXPECT_EQ(values[(*places)[i]], sorted[i]);
      }
    if (n > 256) continue;
    std::vector<std::uint32_t> all(n), order = got.order;
    std::iota(all.begin(), all.end(), 0U);
    std::ranges::sort(order);
    EXPECT_EQ(order, all);
  }
}

}  // namespace
}  // namespace rastrum::test::cuda_layers_test
