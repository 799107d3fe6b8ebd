// SPDX-License-Identifier: BSD-3-Clause
// Pieces that device code makes, here on the CPU.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/raster/cuda/by_size.cuh>
#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/samples.hpp>

#include "tests/support/draws_of.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::cuda_pieces_test {
namespace {

/// Room of a queue: more than needed.
constexpr std::uint64_t kRoom = 1 << 16;

struct KeepsAll {
  bool operator()(const raster::Piece&) const { return true; }
};
struct KeepsFlagged {
  std::uint32_t any;
  bool operator()(const raster::Piece& piece) const { return (piece.flags & any) != 0; }
};

bool by_bytes(const raster::Piece& a, const raster::Piece& b) {
  return std::memcmp(&a, &b, sizeof a) < 0;
}
void expect_same_bytes(const std::vector<raster::Piece>& a, const std::vector<raster::Piece>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(raster::Piece)) == 0);
}

struct MadePieces {
  std::vector<raster::Piece> pieces;  ///< in order of submission
  raster::Outcomes sum;
};
/// The pieces of all primitives for which keep(piece) holds, counted and written as the device's
/// listings do.
template <class Keep>
MadePieces make_pieces(parallel::Cuda& exec, const raster::DeviceScene<parallel::Cuda>& scene,
                       Keep keep, const raster::SamplePattern& samples = {}) {
  const auto n = static_cast<std::size_t>(scene.primitives());
  const raster::Assembly assembly{scene.geometry(), 0, samples};
  auto outcomes = parallel::make_buffer<raster::Outcome>(exec, n);
  parallel::tabulate(exec, outcomes, raster::cuda_detail::CountPieces<Keep>{assembly, keep});
  const auto pieces = raster::write_pieces(exec, assembly, parallel::counting(n), outcomes, keep);
  return {parallel::to_host(exec, pieces),
          parallel::reduce(exec, outcomes, raster::Outcomes{}, raster::AddOutcomes{})};
}

// From arrays that are already on the device.
TEST(CudaPieces, AreTheHostsInOrderOfSubmission) {
  constexpr int kWidth = 200, kHeight = 120;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const GeneratedScene g = generate(seed, kWidth, kHeight);
    const Mat4d to_clip = world_to_clip(g.camera, kWidth, kHeight);
    std::vector<raster::Draw> draws = draws_of(g.view(), to_clip);
    std::vector<raster::DeviceDraw> device_draws;
    parallel::Cuda exec;
    std::vector<parallel::DeviceBuffer<std::uint32_t>> indices;
    std::vector<parallel::DeviceBuffer<Vec3>> positions;
    for (std::size_t i = 0; i < draws.size(); ++i) {
      const InstanceView& instance = g.view().instances[i];
      raster::Draw there = draws[i];
      there.indices =
          parallel::view_of(indices.emplace_back(parallel::to_device(exec, there.indices)));
      const auto& vertices =
          positions.emplace_back(parallel::to_device(exec, instance.mesh()->positions.packed()));
      device_draws.push_back(
          {there, {parallel::view_of(vertices), to_clip * instance.object_to_world, {}, {}}});
    }
    const auto total = raster::number_draws(draws).primitives;
    raster::FrameGeometry frame{kWidth, kHeight, raster::Viewport::of(kWidth, kHeight), draws};
    for (const bool project_first : {true, false}) {
      const raster::DeviceScene<parallel::Cuda> scene(exec, device_draws, kWidth, kHeight, 0,
                                                      project_first);
      ASSERT_EQ(scene.primitives(), total);
      for (const int samples : {1, 4, 16}) {
        // Finds the pieces that each sample sees, and the outcome of primitives that only some
        // samples see.
        const auto pattern = raster::SamplePattern::of(samples);
        std::vector<std::vector<raster::Piece>> expected(static_cast<std::size_t>(samples));
        raster::Outcomes sum;
        for (const raster::Draw& d : draws)
          for (std::uint64_t p = 0; p < d.primitive_count; ++p) {
            raster::Outcome o;
            for (std::size_t s = 0; s < expected.size(); ++s) {
              const raster::Fate fate = raster::assemble_primitive(
                  frame, d, p, [&](const raster::Piece& piece) { expected[s].push_back(piece); }, 0,
                  pattern.at[s]);
              if (fate != raster::Fate::culled) o.fate = fate;
            }
            sum = raster::AddOutcomes{}(sum, raster::Outcomes(o));
          }
        const auto made = make_pieces(exec, scene, KeepsAll{}, pattern);
        EXPECT_EQ(made.sum.culled, sum.culled);
        EXPECT_EQ(made.sum.clipped, sum.clipped);
        EXPECT_EQ(made.sum.dropped, sum.dropped);
        for (std::size_t s = 0; s < expected.size(); ++s) {
          std::vector<raster::Piece> seen;
          for (const raster::Piece& piece : made.pieces) {
            const raster::Piece p = raster::moved(piece, pattern.at[s]);
            if (!raster::piece_bounds(p, {0, 0, kWidth, kHeight}).empty()) seen.push_back(p);
          }
          // Pieces of a clipped primitive that the first sample misses come later.
          if (samples > 1) {
            std::ranges::sort(seen, by_bytes);
            std::ranges::sort(expected[s], by_bytes);
          }
          expect_same_bytes(seen, expected[s]);
        }
      }
    }
  }
}

// Flagged pieces are left out of the keys, in all three size classes, and kept for their own stage.
TEST(CudaPieces, AreKeptAndLeftOutByTheirFlags) {
  constexpr int kSize = 256;
  Random random(5);
  std::vector<Vec3> positions[2];
  for (int t = 0; t < 400; ++t) {
    const double size = t % 20 == 0 ? 200 : t % 3 == 0 ? 30 : 4;
    const double x = random.real(0, kSize), y = random.real(0, kSize);
    for (int c = 0; c < 3; ++c)
      positions[t % 2].push_back(at_pixel(x + random.real(-size, size),
                                          y + random.real(-size, size), random.real(0.1, 0.9),
                                          kSize, kSize));
  }
  const Mat4d to_clip = world_to_clip(pixel_camera(kSize, kSize), kSize, kSize);
  parallel::Cuda exec;
  const parallel::DeviceBuffer<Vec3> there[2] = {parallel::to_device(exec, positions[0]),
                                                 parallel::to_device(exec, positions[1])};
  raster::DeviceDraw draws[2];
  for (int d = 0; d < 2; ++d) {
    draws[d].draw.vertex_count = positions[d].size();
    draws[d].draw.primitive_count = positions[d].size() / 3;
    draws[d].vertices.positions = parallel::view_of(there[d]);
    draws[d].vertices.object_to_clip = to_clip;
  }
  draws[1].draw.flags = kTranslucent;
  std::vector<std::uint64_t> fragments;
  const auto keys_of = [&](std::span<const raster::DeviceDraw> drawn, std::uint32_t skip,
                           std::uint64_t queued_pieces = kRoom,
                           std::uint64_t queued_tiles = kRoom) {
    const raster::DeviceScene<parallel::Cuda> scene(exec, drawn, kSize, kSize);
    auto keys = parallel::to_device(exec, std::vector<std::uint64_t>(kSize * kSize));
    const raster::Rect view{0, 0, kSize, kSize};
    const raster::DeviceSurface surface{view, {0, 0, kSize / 8, keys.data(), nullptr}};
    auto split = raster::DeviceSplit::of(0, kSize, kSize, scene.primitives(), 0, 0);
    split.queued_pieces = queued_pieces;
    split.queued_tiles = queued_tiles;
    raster::BySize drawer;
    auto sums = parallel::to_device(exec, std::vector<std::uint64_t>(raster::kBandSums));
    drawer.draw(exec, scene, surface, split, skip, {}, {}, sums.data());
    raster::BandSums counted;
    std::ranges::copy(parallel::to_host(exec, sums), counted.begin());
    drawer.end_band(counted);
    EXPECT_GT(counted[raster::kFragmentsSum], 0U);
    EXPECT_EQ(counted[raster::kInvalidSum], 0U);
    FrameStats stats;
    drawer.end_frame(stats);
    EXPECT_EQ(counter(stats, "tile pairs") > 0, queued_pieces > 0 && queued_tiles > 0);
    EXPECT_EQ(counter(stats, "larger pieces") > 0, queued_pieces > 0);
    fragments.push_back(counted[raster::kFragmentsSum]);
    return parallel::to_host(exec, keys);
  };
  const auto all = keys_of(draws, 0), kept = keys_of(draws, kTranslucent);
  EXPECT_EQ(kept, keys_of({draws, 1}, 0));
  EXPECT_NE(kept, all);

  // If a queue is full, pieces are drawn where they are found.
  fragments.resize(1);
  for (const std::uint64_t room_of_pieces : {kRoom, std::uint64_t{7}, std::uint64_t{0}})
    for (const std::uint64_t room_of_tiles : {kRoom, std::uint64_t{21}, std::uint64_t{0}}) {
      EXPECT_EQ(keys_of(draws, 0, room_of_pieces, room_of_tiles), all)
          << room_of_pieces << ' ' << room_of_tiles;
      EXPECT_EQ(fragments.back(), fragments.front());
    }

  const raster::DeviceScene<parallel::Cuda> scene(exec, draws, kSize, kSize);
  const MadePieces made = make_pieces(exec, scene, KeepsAll{});
  const MadePieces flagged = make_pieces(exec, scene, KeepsFlagged{kTranslucent});
  std::vector<std::uint64_t> expected, ids;
  for (const raster::Piece& p : made.pieces)
    if ((p.flags & kTranslucent) != 0) expected.push_back(raster::id_of_key(p.low));
  for (const raster::Piece& p : flagged.pieces) ids.push_back(raster::id_of_key(p.low));
  EXPECT_EQ(ids, expected);
  EXPECT_GT(ids.size(), 150U);
}

// Pieces that by-size leaves out are in the queue of others, each once. A clipped triangle's pieces
// are adjacent, followed by another triangle's piece. The queue's counter shows if the queue was
// too small.
TEST(CudaPieces, WhatIsLeftToOthersIsInTheirQueue) {
  // Its arrays are the host's, so memory that is allocated during its life has no wall.
  const parallel::cuda_system::Walls::Unseen on_either_side;
  constexpr int kWidth = 200, kHeight = 120;
  std::uint64_t clipped = 0, too_many = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const GeneratedScene g = generate(seed, kWidth, kHeight);
    SCOPED_TRACE(g.kind);
    const Mat4d to_clip = world_to_clip(g.camera, kWidth, kHeight);
    std::vector<raster::DeviceDraw> draws;
    const std::vector<raster::Draw> on_host = draws_of(g.view(), to_clip);
    for (std::size_t i = 0; i < on_host.size(); ++i) {
      const InstanceView& instance = g.view().instances[i];
      raster::DeviceDraw& d = draws.emplace_back();
      d.draw = on_host[i];
      d.draw.source = {};
      d.draw.flags = kTranslucent;
      d.vertices = {
          instance.mesh()->positions.packed(), to_clip * instance.object_to_world, {}, {}};
    }
    parallel::Cuda exec;
    const raster::DeviceScene<parallel::Cuda> scene(exec, draws, kWidth, kHeight);
    for (const int samples : {1, 4}) {
      const auto pattern = raster::SamplePattern::of(samples);
      std::vector<raster::Piece> expected = make_pieces(exec, scene, KeepsAll{}, pattern).pieces;
      std::ranges::sort(expected, by_bytes);
      for (const std::size_t room : {std::size_t{kRoom}, expected.size() / 2 + 1}) {
        const raster::Rect view{0, 0, kWidth, kHeight};
        std::vector<std::uint64_t> keys(raster::block_count(view) * 64 *
                                        static_cast<std::size_t>(samples));
        const raster::DeviceSurface surface{view,
                                            {0, 0, kWidth / 8, keys.data(), nullptr},
                                            nullptr,
                                            raster::block_count(view) * 64,
                                            pattern};
        const auto split = raster::DeviceSplit::of(0, kWidth, kHeight, scene.primitives(), 0, 0);
        std::vector<std::uint64_t> sums(raster::kBandSums);
        std::vector<raster::Piece> queue(room);
        raster::BySize drawer;
        drawer.draw(exec, scene, surface, split, kTranslucent, {queue, &sums[raster::kLeftSum]}, {},
                    sums.data());
        exec.wait();
        EXPECT_EQ(sums[raster::kFragmentsSum], 0U);
        if (sums[raster::kLeftSum] > room) {
          ++too_many;
          EXPECT_LT(room, kRoom);
          continue;
        }
        std::vector<raster::Piece> left;
        for (std::size_t i = 0; i < sums[raster::kLeftSum]; ++i) {
          if (queue[i].flags == 0) continue;
          left.push_back(queue[i]);
          if ((queue[i].flags & raster::kClipped) == 0) continue;
          ++clipped;
          std::size_t last = i;
          while (queue[last + 1].low == queue[i].low) ++last;
          ASSERT_LT(last + 1, sums[raster::kLeftSum]);
          EXPECT_EQ(
              std::count_if(expected.begin(), expected.end(),
                            [&](const raster::Piece& p) { return p.low == queue[i].low; }),
              std::count_if(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                            [&](const raster::Piece& p) { return p.low == queue[i].low; }));
        }
        std::ranges::sort(left, by_bytes);
        expect_same_bytes(left, expected);
      }
    }
  }
  EXPECT_GT(clipped, 20U);
  EXPECT_GT(too_many, 10U);
}

}  // namespace
}  // namespace rastrum::test::cuda_pieces_test
