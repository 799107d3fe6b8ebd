// Words on a surface that ranks share: when it is taken, that nothing of a frame is left on it for
// the next, and how often ranks meet.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks/shared_layers.hpp>

#include "tests/ranks/deals.hpp"

namespace rastrum::test::shared_test {
namespace {

struct Few {
  PartsScene parts{12, kParts, false};
  SceneBinding binding{parts.scene};
  Camera camera = fit_camera(binding.view(), 1.0472F, false);
  FrameOptions frame = frame_of(Shader::phong, 90, 70);
};

/// The picture of `ranks`, compared with one renderer's.
RanksStats draw_and_compare(LocalRanks& ranks, int count, const Few& few, const Camera& camera,
                            const RanksOptions& options = {},
                            const RendererOptions& of_rank = {.device = Device::serial}) {
  const AllTargets one(few.frame.width, few.frame.height, false);
  const AllTargets many(few.frame.width, few.frame.height, false);
  Renderer renderer({.threads = 1});
  (void)renderer.render(few.binding.view(), camera, few.frame, one.targets());
  const RanksStats stats = draw_dealt(ranks, round_robin(count), few.binding.view(), camera,
                                      few.frame, many.targets(), options, {}, of_rank);
  EXPECT_TRUE(same_targets(one.targets(), many.targets()));
  return stats;
}

TEST(SharedWords, AreTakenByRanksOfOneNode) {
  const Few few;
  for (const int n : {2, 3, 16, 64}) {
    LocalRanks ranks(n);
    EXPECT_EQ(draw_and_compare(ranks, n, few, few.camera).exchange, WordExchange::shared) << n;
  }
  for (const WordExchange wanted : {WordExchange::automatic, WordExchange::shared}) {
    LocalRanks of_nodes(5, 3);
    RanksOptions options{.exchange = wanted};
    const RanksStats stats = draw_and_compare(of_nodes, 5, few, few.camera, options);
    EXPECT_EQ(stats.exchange, WordExchange::sparse);
  }
  // An exchange that was asked for is taken.
  LocalRanks ranks(3);
  RanksOptions options{.exchange = WordExchange::sparse};
  EXPECT_EQ(draw_and_compare(ranks, 3, few, few.camera, options).exchange, WordExchange::sparse);
}

/// The surface is a quarter of a rank's memory limit at most, and all ranks keep the least.
TEST(SharedWords, AreNotTakenWhereMemoryIsScarce) {
  Few few;
  few.frame.width = 1024;
  few.frame.height = 1024;
  // Words, and where layers begin, of which is as much as there are ranks and blocks.
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

/// Nothing goes to owners but what the picture wants.
TEST(SharedWords, SendLess) {
  const Few few;
  const auto traffic = [&](WordExchange exchange) {
    LocalRanks ranks(8);
    RanksOptions options{.exchange = exchange};
    (void)draw_and_compare(ranks, 8, few, few.camera, options);
    return ranks.traffic()[3];  // not the root
  };
  const auto shared = traffic(WordExchange::shared), sparse = traffic(WordExchange::sparse);
  EXPECT_LT(shared.messages * 3, sparse.messages * 2);
  EXPECT_LT(shared.bytes, sparse.bytes);
}

/// A frame that fails with words on the surface leaves none to the next, which sees other things.
TEST(SharedWords, OfAFrameThatFailedAreGone) {
  Few few;
  LocalRanks ranks(4);
  Camera near = few.camera;
  near.eye = near.target + (near.eye - near.target) * 0.7;
  for (const float opacity : {1.0F, 0.5F}) {
    // The first parts alone, so that opaque surfaces are there, too.
    for (std::size_t p = 0; p < kParts / 2; ++p) few.parts.scene.instances[p].opacity = opacity;
    few.binding = SceneBinding(few.parts.scene);
    for (const char* phase : {"make words", "raise words", "look who has won", "shade",
                              "look what hides", "pack pixels", "finish"}) {
      const auto fails = [&](std::string_view name, int rank) {
        if (name == phase && rank == 2) throw Error(Errc::io, "the disk is full");
      };
      Image<Vec4> image(few.frame.width, few.frame.height);
      std::string said;
      try {
        draw_dealt(ranks, contiguous(4), few.binding.view(), near, few.frame, {.color = image}, {},
                   fails);
      } catch (const Error& e) {
        said = e.what();
      }
      const bool is_there = opacity != 1 || std::string(phase) != "look what hides";
      EXPECT_EQ(said, is_there && (opacity == 1 || std::string(phase) != "pack pixels")
                          ? "rank 2: the disk is full"
                          : "")
          << phase;
      (void)draw_and_compare(ranks, 4, few, few.camera);
    }
  }
}

/// Counts how often ranks meet.
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
  const Few few;
  const auto meetings = [&](float opacity) {
    FrameOptions frame = few.frame;
    frame.opacity = opacity;
    LocalRanks ranks(16);
    std::vector<int> counts(16);
    Image<Vec4> image(frame.width, frame.height);
    ranks.run([&](Communicator& c) {
      Meetings counted(c);
      const auto r = static_cast<std::size_t>(c.rank());
      SceneView own = few.binding.view();
      own.instances = own.instances.subspan(r, 1);
      const std::uint64_t part = r;
      Renderer renderer({.device = Device::serial});
      (void)render_parts(counted, renderer, own, {&part, 1}, few.camera, frame,
                         r == 0 ? Targets{.color = image} : Targets{});
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
