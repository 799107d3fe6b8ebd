// SPDX-License-Identifier: BSD-3-Clause
// Layers in memory that ranks share: they are there if they fit, and the picture is one renderer's,
// for any number of ranks and any leftovers of earlier frames.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks/root_picture.hpp>
#include <rastrum/ranks/shared_layers.hpp>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::shared_layers_test {
namespace {

constexpr std::string_view kLay = "lay fragments", kSend = "pack fragments", kTake = "take layers";

/// A scene of opaque and translucent parts, or only translucent ones.
Scene glass_of(bool all) {
  Scene scene = PartsScene(31, kParts, false).scene;
  for (std::size_t p = 0; p < kParts; ++p)
    if (all || p % 3 != 0) scene.instances[p].opacity = 0.3F;
  return scene;
}
FrameOptions frame_with(int width, int height, int samples) {
  FrameOptions frame = frame_of(Shader::phong, width, height);
  frame.samples = samples;
  return frame;
}
struct Glass : Whole {
  Glass(int width, int height, int samples = 1, bool all = false)
      : Whole(glass_of(all), frame_with(width, height, samples)) {}
  /// Expects that `ranks` draw the same, and that `phase` occurs. Threads with shared fragments
  /// draw directly into the root's picture; the root collects from processes.
  void expect(LocalRanks& ranks, const Deal& deal, std::string_view phase,
              const RanksOptions& options = {}, const RendererOptions& of_rank = kSerialRank,
              bool as_processes = false) const {
    std::atomic<bool> seen = false, takes = false;
    Whole::expect(
        ranks, deal, options, of_rank,
        [&](std::string_view name, int) {
          if (name == phase) seen = true;
          if (name == kTake) takes = true;
        },
        as_processes);
    EXPECT_TRUE(seen) << phase;
    EXPECT_EQ(takes, as_processes || phase != kLay);
  }
};

/// With and without opaque surfaces; in a first frame, which finds no room because the need is
/// unknown, and in a later one.
TEST(SharedLayers, EqualOneRenderer) {
  Random random(3);
  for (const int samples : {1, 4})
    for (const bool all : {false, true}) {
      const Glass glass(40, 30, samples, all);
      for (int n = 2; n <= 16; n += samples == 1 ? 1 : 7) {
        LocalRanks ranks(n);
        const Deal deal = random_deal(n, random);
        for (int frame = 0; frame < 2; ++frame)
          for (const bool as_processes : {false, true})
            glass.expect(ranks, deal, kLay, {}, {.threads = 1}, as_processes);
        if (n % 7 == 2) glass.expect(ranks, all_on_last(n), kLay);
      }
    }
}

TEST(SharedLayers, OfMoreRanksThanBlocks) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{9, 5}, std::pair{8, 24}}) {
    LocalRanks ranks(16);
    Glass(width, height, 1, true).expect(ranks, round_robin(16), kLay);
  }
}

TEST(SharedLayers, OfThreadsOfARank) {
  const Glass glass(150, 100);
  LocalRanks ranks(3);
  for (const bool as_processes : {false, true})
    glass.expect(ranks, round_robin(3), kLay, {}, {.threads = 3}, as_processes);
}

/// Frames and bands of other sizes, each on the leftovers of the one before.
TEST(SharedLayers, LeaveNothingToLaterFrames) {
  const Glass small(40, 30), large(130, 90, 1, true), samples(50, 40, 4);
  LocalRanks ranks(5);
  for (int i = 0; i < 2; ++i)
    for (const Glass* const glass : {&small, &large, &samples, &small})
      glass->expect(ranks, round_robin(5), kLay);
  RanksOptions rows{.rows = 64};
  int at = 0;
  Image<Vec4> whole(130, 90), band(130, 64);
  rows.take_rows = [&](int first, int last) {
    EXPECT_EQ(first, at);
    at = last;
    for (int y = first; y < last; ++y)
      for (int x = 0; x < 130; ++x) whole(x, y) = band(x, y - first);
  };
  large.draw(ranks, round_robin(5), {.color = band}, rows);
  EXPECT_EQ(at, 90);
  EXPECT_TRUE(same_targets({.color = large.one().color}, {.color = whole}));
}

/// A failed frame has stored and partly blended its layers, but leaves no trace.
TEST(SharedLayers, OfAFrameThatFailedAreGone) {
  const Glass glass(60, 50), other(60, 50, 1, true);
  LocalRanks ranks(4);
  for (const std::string_view phase :
       {std::string_view("draw"), std::string_view("look what hides"), kLay,
        std::string_view("blend"), kTake}) {
    Image<Vec4> image(60, 50);
    const auto draw = [&] {
      other.draw(
          ranks, contiguous(4), {.color = image}, {}, kSerialRank,
          [&](std::string_view name, int rank) {
            if (name == phase && rank == 2) throw Error(Errc::io, "the disk is full");
          },
          phase == kTake);
    };
    if (phase == "look what hides")
      draw();  // all are translucent: nothing hides
    else
      EXPECT_EQ(refusal_of(draw, Errc::io), "rank 2: the disk is full");
    glass.expect(ranks, round_robin(4), kLay);
  }
}

/// If all layers exceed the shared memory, they are sent.
TEST(SharedLayers, FindRoomOrAreSent) {
  const Glass glass(120, 90, 1, true);
  LocalRanks ranks(12);
  const auto expect = [&](std::uint64_t limit, std::string_view phase) {
    glass.expect(ranks, round_robin(12), phase, {},
                 {.memory_limit = limit, .device = Device::serial});
  };
  // A quarter is more than three times one rank's need, but less than all ranks'.
  constexpr std::uint64_t kLittle = std::uint64_t{4} << 20;
  expect(kLittle, kSend);
  expect(0, kLay);
  expect(kLittle, kSend);
  RanksOptions sent{.exchange = WordExchange::sparse};
  glass.expect(ranks, round_robin(12), kSend, sent);
  LocalRanks of_nodes(12, 7);
  glass.expect(of_nodes, round_robin(12), kSend);
}

/// The root leaves while another rank is about to draw into its picture, which must then be gone.
TEST(SharedLayers, NobodyDrawsIntoAPictureThatHasGone) {
  class LeavesAtBlend final : public AsProcesses {
   public:
    using AsProcesses::AsProcesses;
    void begin_phase(std::string_view name) override { leaves_ = name == "blend"; }
    [[nodiscard]] bool is_one_process() const override { return true; }
    void max_of_each(std::span<std::uint64_t> values) override {
      if (leaves_) throw Error(Errc::io, "the cable is cut");
      AsProcesses::max_of_each(values);
    }

   private:
    bool leaves_ = false;
  };
  const Glass glass(60, 50, 1, true);
  LocalRanks ranks(3);
  std::atomic<bool> root_is_gone = false;
  const auto draw = [&] {
    ranks.run([&](Communicator& threads) {
      LeavesAtBlend leaves(threads);
      Communicator& c = threads.rank() == 1 ? leaves : threads;
      const auto r = static_cast<std::uint64_t>(c.rank());
      const auto at = [&](std::string_view name, int rank) {
        while (name == "blend" && rank == 2 && !root_is_gone) std::this_thread::yield();
      };
      try {
        Image<Vec4> own_image(60, 50);
        glass.draw_on(c, {&r, 1}, {.color = own_image}, {}, kSerialRank, at);
      } catch (const Error&) {
        if (r == 0) root_is_gone = true;
        throw;
      }
    });
  };
  EXPECT_EQ(refusal_of(draw, Errc::io), "the cable is cut");
  glass.expect(ranks, round_robin(3), kLay);
}

/// The root waits while ranks draw into its picture.
TEST(SharedLayers, APictureStaysWhileSomebodyDrawsIntoIt) {
  std::vector<std::uint64_t> memory(100);
  const ranks::SharedLayers layers(memory, 5, 2);
  const ranks::BlockGrid grid(16, 0, 16, 2);
  ranks::RootPicture picture(grid, {}, nullptr);
  for (int turn = 0; turn < 20; ++turn) {
    std::atomic<bool> is_gone = false;
    auto open = std::make_optional<ranks::SharedLayers::OpenPicture>(layers, picture);
    auto visit = std::make_optional<ranks::SharedLayers::Visit>(layers);
    EXPECT_EQ(visit->picture(), &picture);
    std::thread root([&] {
      open.reset();
      is_gone = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_FALSE(is_gone);
    visit.reset();
    root.join();
    EXPECT_EQ(ranks::SharedLayers::Visit(layers).picture(), nullptr);
  }
}

/// Memory is given to the first request, and never beyond its end.
TEST(SharedLayers, RoomIsGivenOnce) {
  constexpr std::size_t kBlocks = 5, kNumbers = 40'000;
  constexpr int kRanks = 3;
  std::vector<std::uint64_t> memory(kNumbers);
  const ranks::SharedLayers layers(memory, kBlocks, kRanks);
  for (std::size_t r = 0; r < kRanks; ++r) layers.clear(r);
  const std::uint64_t first = layers.size();
  for (int frame = 0; frame < 2; ++frame) {
    layers.clear_room();
    std::vector<std::vector<std::span<std::byte>>> given(kRanks);
    std::vector<std::thread> threads;
    for (std::size_t r = 0; r < kRanks; ++r)
      threads.emplace_back([&, r] {
        for (std::size_t bytes = 1 + r; std::byte* const at = layers.room(bytes);
             bytes = 1 + bytes * 7 % 1009)
          given[r].emplace_back(at, bytes);
      });
    for (std::thread& t : threads) t.join();
    std::vector<std::span<std::byte>> all;
    for (const auto& of_rank : given) all.insert(all.end(), of_rank.begin(), of_rank.end());
    std::ranges::sort(all, {}, [](const auto& s) { return s.data(); });
    const std::byte* end = reinterpret_cast<const std::byte*>(&memory[first]);
    for (const auto& s : all) {
      EXPECT_GE(s.data(), end);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(s.data()) % alignof(ranks::FragmentRun), 0U);
      end = s.data() + s.size();
    }
    EXPECT_LE(end, reinterpret_cast<const std::byte*>(&memory[0] + kNumbers));
    // Single numbers fill the rest, up to the last.
    while (layers.room(1) != nullptr) {
    }
    EXPECT_EQ(layers.size(), kNumbers);
  }
}

/// Each block goes to the first rank that asks.
TEST(SharedLayers, EachBlockIsTakenOnce) {
  constexpr std::size_t kBlocks = 1003;
  constexpr int kRanks = 4;
  std::vector<std::uint64_t> memory(ranks::SharedLayers::table_size(kBlocks, kRanks), 7);
  const ranks::SharedLayers layers(memory, kBlocks, kRanks);
  layers.clear_room();
  for (std::size_t r = 0; r < kRanks; ++r) layers.clear(r);
  EXPECT_TRUE(std::ranges::all_of(memory, [](std::uint64_t n) { return n == 0; }));
  std::vector<std::atomic<int>> taken(kBlocks);
  std::vector<std::thread> threads;
  for (int r = 0; r < kRanks; ++r)
    threads.emplace_back([&] {
      for (auto run = layers.take(); run.first != run.last; run = layers.take())
        for (std::size_t b = run.first; b < run.last; ++b) ++taken[b];
    });
  for (std::thread& t : threads) t.join();
  EXPECT_TRUE(std::ranges::all_of(taken, [](const auto& n) { return n == 1; }));
}

}  // namespace
}  // namespace rastrum::test::shared_layers_test
