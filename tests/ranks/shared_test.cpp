// SPDX-License-Identifier: BSD-3-Clause
// Words on a surface that ranks share: when it is used, that nothing of a frame stays for the next,
// and how often ranks synchronize.
#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks/shared_layers.hpp>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::shared_test {
namespace {

struct Few : Whole {
  explicit Few(int width = 90, int height = 70)
      : Whole(PartsScene(12, kParts, false).scene, frame_of(Shader::phong, width, height)) {}
};

TEST(SharedWords, AreTakenByRanksOfOneNode) {
  const Few few;
  for (const int n : {2, 3, 16, 64}) {
    LocalRanks ranks(n);
    EXPECT_EQ(few.expect(ranks, round_robin(n)).exchange, WordExchange::shared) << n;
  }
  for (const WordExchange wanted : {WordExchange::automatic, WordExchange::shared}) {
    LocalRanks of_nodes(5, 3);
    EXPECT_EQ(few.expect(of_nodes, round_robin(5), {.exchange = wanted}).exchange,
              WordExchange::sparse);
  }
  // An exchange that is requested is used.
  LocalRanks ranks(3);
  EXPECT_EQ(few.expect(ranks, round_robin(3), {.exchange = WordExchange::sparse}).exchange,
            WordExchange::sparse);
}

/// The surface takes at most a quarter of a rank's memory limit; the smallest limit counts.
TEST(SharedWords, AreNotTakenWhereMemoryIsScarce) {
  const Few few(1024, 1024);
  // Words, and the table of layers, whose size depends on ranks and blocks.
  const std::uint64_t least = 4 * 8 * (1024 * 1024 + ranks::SharedLayers::table_size(128 * 128, 2));
  LocalRanks two(2);
  Image<std::int64_t> ids(1024, 1024);
  const auto exchange_with = [&](std::uint64_t limit) {
    RanksStats of_root;
    two.run([&](Communicator& c) {
      Renderer renderer({.memory_limit = c.rank() == 1 ? limit : 0, .device = Device::serial});
      const RanksStats stats = render_parts(c, renderer, {}, {}, few.camera, few.frame,
                                            c.rank() == 0 ? Targets{.ids = ids} : Targets{});
      if (c.rank() == 0) of_root = stats;
    });
    return of_root.exchange;
  };
  EXPECT_EQ(exchange_with(least), WordExchange::shared);
  EXPECT_NE(exchange_with(least - 4), WordExchange::shared);
}

/// Owners receive only what the picture needs.
TEST(SharedWords, SendLess) {
  const Few few;
  const auto traffic = [&](WordExchange exchange) {
    LocalRanks ranks(8);
    few.expect(ranks, round_robin(8), {.exchange = exchange});
    return ranks.traffic()[3];  // not the root
  };
  const auto shared = traffic(WordExchange::shared), sparse = traffic(WordExchange::sparse);
  EXPECT_LT(shared.messages * 3, sparse.messages * 2);
  EXPECT_LT(shared.bytes, sparse.bytes);
}

/// A failed frame leaves no words on the surface for the next one, which shows other things.
TEST(SharedWords, OfAFrameThatFailedAreGone) {
  LocalRanks ranks(4);
  for (const float opacity : {1.0F, 0.5F}) {
    // Only the first parts are translucent, so that there are opaque surfaces too.
    Scene scene = PartsScene(12, kParts, false).scene;
    for (std::size_t p = 0; p < kParts / 2; ++p) scene.instances[p].opacity = opacity;
    const Whole few(scene, frame_of(Shader::phong, 90, 70));
    Camera camera = few.camera;
    camera.eye = camera.target + (camera.eye - camera.target) * 0.7;
    const Whole near(scene, few.frame, camera);
    for (const std::string_view phase : {"make words", "raise words", "look who has won", "shade",
                                         "look what hides", "pack pixels", "finish"}) {
      SCOPED_TRACE(phase);
      Image<Vec4> image(few.frame.width, few.frame.height);
      const auto draw = [&] {
        near.draw(ranks, contiguous(4), {.color = image}, {}, kSerialRank,
                  [&](std::string_view name, int rank) {
                    if (name == phase && rank == 2) throw Error(Errc::io, "the disk is full");
                  });
      };
      if (phase == (opacity == 1 ? "look what hides" : "pack pixels"))
        draw();  // there is no such phase
      else
        EXPECT_EQ(refusal_of(draw, Errc::io), "rank 2: the disk is full");
      few.expect(ranks, round_robin(4));
    }
  }
}

/// Counts the synchronizations of ranks.
class Meetings final : public AsProcesses {
 public:
  using AsProcesses::AsProcesses;
  [[nodiscard]] std::uint64_t max(std::uint64_t value) override {
    ++count;
    return AsProcesses::max(value);
  }
  void max_of_each(std::span<std::uint64_t> values) override {
    ++count;
    AsProcesses::max_of_each(values);
  }
  void broadcast(std::span<std::byte> bytes, int root) override {
    ++count;
    AsProcesses::broadcast(bytes, root);
  }
  void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) override {
    ++count;
    AsProcesses::exchange_sizes(to, from);
  }
  void exchange(std::span<const std::span<const std::byte>> to,
                std::span<const std::span<std::byte>> from) override {
    ++count;
    AsProcesses::exchange(to, from);
  }
  int count = 0;
};

TEST(SharedWords, TakeFewMeetings) {
  Few few;
  const auto meetings = [&](float opacity) {
    few.frame.opacity = opacity;
    LocalRanks ranks(16);
    std::vector<int> counts(16);
    Image<Vec4> image(few.frame.width, few.frame.height);
    ranks.run([&](Communicator& c) {
      Meetings counted(c);
      const auto r = static_cast<std::uint64_t>(c.rank());
      few.draw_on(counted, {&r, 1}, {.color = image});
      counts[r] = counted.count;
    });
    EXPECT_EQ(std::ranges::min(counts), std::ranges::max(counts));
    return counts[0];
  };
  EXPECT_LE(meetings(1), 14);
  EXPECT_LE(meetings(0.3F), 10);
}

}  // namespace
}  // namespace rastrum::test::shared_test
