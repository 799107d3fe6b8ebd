// SPDX-License-Identifier: BSD-3-Clause
// An error on one rank, in any phase, ends the frame on all ranks with the same error, and the next
// frame is not affected.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <iterator>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/stop.hpp>

#include "tests/ranks/parts_picture.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::failures_test {
namespace {

struct Way {
  int samples = 1;
  RanksOptions options{};
  bool shadows = false;
};

/// Each rank's error of one frame; "" if it ended well.
std::vector<std::string> messages(LocalRanks& ranks, int count, const SceneView& all,
                                  const ranks::AtPhase& at, const Way& way) {
  const Camera camera{.eye = {0, 0, 3}};
  FrameOptions frame{.width = 16, .height = 16, .samples = way.samples};
  if (way.shadows) frame.lights = {{.kind = DirectionalLight{{0.3F, -1, -0.5F}}}};
  frame.shadows = way.shadows;
  std::vector<std::string> said(static_cast<std::size_t>(count));
  Image<Rgba8> image(16, 16);
  Image<std::int64_t> ids(16, 16);
  ranks.run([&](Communicator& c) {
    const auto r = static_cast<std::size_t>(c.rank());
    SceneView own = all;
    own.instances =
        r < all.instances.size() ? all.instances.subspan(r, 1) : std::span<const InstanceView>{};
    const std::uint64_t part = r;
    // Shadows need a drawing thread instead of the serial device, because a light's picture is
    // large.
    Renderer renderer(way.shadows ? kThreadRank : kSerialRank);
    Targets targets;
    if (r == 0) targets = {.color8 = image, .ids = ids};
    try {
      (void)ranks::render_parts(c, renderer, own, std::span(&part, own.instances.size()), camera,
                                frame, targets, way.options, at);
    } catch (const std::exception& e) {
      said[r] = e.what();
    }
  });
  return said;
}

/// The first part is translucent, so that there are layers' phases, and there are numbers, whose
/// range the ranks agree on.
Scene glass() {
  Scene scene = PartsScene(9, 3, false).scene;
  scene.instances[0].opacity = 0.5F;
  scene.scalar_mappings = {{.map = color_map("viridis")}};
  scene.instances[1].scalar = 0.3;
  scene.instances[2].scalar = 2;
  return scene;
}

class Failures : public testing::Test {
 protected:
  const Scene scene = glass();
  const SceneBinding binding{scene};

  /// The phases, which are the same on all ranks.
  std::set<std::string> phases(const Way& way = {}) {
    std::set<std::string> names;
    LocalRanks two(2);
    messages(
        two, 2, binding.view(),
        [&](std::string_view phase, int rank) {
          if (rank == 0) names.emplace(phase);
        },
        way);
    return names;
  }
  void expect_alike(const std::set<std::string>& names, int count, const Way& way) {
    LocalRanks ranks(count);
    for (const std::string& name : names)
      for (int rank = 0; rank < count; ++rank) {
        const auto said = messages(
            ranks, count, binding.view(),
            [&](std::string_view phase, int r) {
              if (phase == name && r == rank) throw Error(Errc::io, "wing.ply: cut short");
            },
            way);
        for (const std::string& message : said)
          ASSERT_EQ(message, "rank " + std::to_string(rank) + ": wing.ply: cut short") << name;
      }
    for (const std::string& message : messages(ranks, count, binding.view(), {}, way))
      EXPECT_EQ(message, "");
  }
};

struct Phases {
  const char* name;
  Way way;
  std::size_t least;
  bool only_whole = false;
};
class FailuresOf : public Failures, public testing::WithParamInterface<Phases> {};

TEST_P(FailuresOf, EndTheFrameOnAllRanksInEachPhase) {
  if (GetParam().only_whole && test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  const auto names = phases(GetParam().way);
  ASSERT_GE(names.size(), GetParam().least);
  expect_alike(names, 4, GetParam().way);
}
constexpr auto kSparse = WordExchange::sparse;
INSTANTIATE_TEST_SUITE_P(
    Ways, FailuresOf,
    testing::Values(
        Phases{"shared", {}, 26}, Phases{"sparse", {1, {.exchange = kSparse}}, 34},
        Phases{"samples", {4}, 20}, Phases{"samples_sparse", {4, {.exchange = kSparse}}, 24},
        Phases{"two_hops", {1, {.exchange = WordExchange::two_hops}}, 42},
        Phases{"bands", {1, {.fragment_bytes = 1}}, 30, true},
        Phases{"bands_of_samples", {4, {.fragment_bytes = 1}}, 20},
        Phases{"bands_sparse", {1, {.exchange = kSparse, .fragment_bytes = 1}}, 34},
        Phases{
            "bands_of_samples_sparse", {4, {.exchange = kSparse, .fragment_bytes = 1}}, 25, true}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(Failures, EndTheFrameOnAllRanksInEachPhaseOfShadows) {
  const Way way{.shadows = true};
  std::set<std::string> names = phases(way);
  for (const std::string& name : phases()) names.erase(name);
  ASSERT_EQ(names.size(), 7U);
  expect_alike(names, 2, way);
}

/// In each phase of each way to draw one rank fails, and others fail at random phases, in several
/// ways. All ranks must report the same. A hang is CTest's timeout.
TEST_F(Failures, AtRandomNeverHang) {
  constexpr int kRanks = 3;
  struct At {
    const Way* way;
    const std::vector<std::string>* phases;
    std::size_t phase;
    int rank;
  };
  const Way ways[] = {{1, {}},
                      {1, {.exchange = kSparse}},
                      {1, {.exchange = WordExchange::two_hops}},
                      {1, {.exchange = kSparse, .fragment_bytes = 1}},
                      {4, {}},
                      {4, {.exchange = kSparse}}};
  std::vector<std::string> names[std::size(ways)];
  std::vector<At> all;
  for (std::size_t w = 0; w < std::size(ways); ++w) {
    const auto set = phases(ways[w]);
    names[w].assign(set.begin(), set.end());
    for (std::size_t p = 0; p < names[w].size(); ++p)
      for (int r = 0; r < kRanks; ++r) all.push_back({&ways[w], &names[w], p, r});
  }
  Random random(1);
  for (std::size_t i = all.size(); i-- > 1;)
    std::swap(all[i], all[static_cast<std::size_t>(random.integer(0, static_cast<int>(i)))]);
  const std::size_t times = test::is_full() ? 10000 : all.size();
  LocalRanks ranks(kRanks);
  std::chrono::steady_clock::duration longest{};
  for (std::size_t i = 0; i < times; ++i) {
    const At& at = all[i % all.size()];
    struct Plan {
      std::size_t phase = 0;
      int how = 0;  ///< 0: does not fail
    };
    Plan plans[kRanks];
    for (int r = 0; r < kRanks; ++r) {
      plans[r].phase =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(at.phases->size()) - 1));
      plans[r].how = std::max(0, random.integer(-3, 4));
    }
    plans[at.rank] = {at.phase, random.integer(1, 4)};
    const auto fail = [&](std::string_view phase, int r) {
      const Plan& p = plans[r];
      if (p.how == 0 || (*at.phases)[p.phase] != phase) return;
      if (p.how == 1) throw Error(Errc::bad_format, "not a file");
      if (p.how == 2) throw std::bad_alloc();
      if (p.how == 3) throw Stopped{};
      throw 3;  // NOLINT: a caller's function may
    };
    const auto begin = std::chrono::steady_clock::now();
    const auto said = messages(ranks, kRanks, binding.view(), fail, *at.way);
    longest = std::max(longest, std::chrono::steady_clock::now() - begin);
    ASSERT_NE(said[0], "") << i;
    for (const std::string& message : said) ASSERT_EQ(message, said[0]) << i;
  }
  RecordProperty("injections", static_cast<int>(times));
  RecordProperty("planned", static_cast<int>(all.size()));
  RecordProperty(
      "longest_ms",
      static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(longest).count()));
}

TEST_F(Failures, KeepCodeAndKind) {
  LocalRanks ranks(3);
  const Whole whole(scene, {.width = 16, .height = 16}, Camera{.eye = {0, 0, 3}});
  Image<Rgba8> image(16, 16);
  const auto draw = [&](const ranks::AtPhase& at) {
    whole.draw(ranks, {{0}, {1}, {2}}, {.color8 = image}, {}, kSerialRank, at);
  };
  expect_refused("rank 2: no memory", Errc::out_of_memory, [&] {
    draw([](std::string_view phase, int r) {
      if (phase == "draw" && r == 2) throw std::bad_alloc();
    });
  });
  EXPECT_THROW(draw([](std::string_view phase, int r) {
                 if (phase == "shade" && r == 1) throw Stopped{};
               }),
               Stopped);
  // With two errors, the lowest rank's is reported.
  expect_refused("rank 1: early", Errc::io, [&] {
    draw([](std::string_view phase, int r) {
      if (phase == "draw" && r > 0) throw Error(Errc::io, r == 1 ? "early" : "late");
    });
  });
}

TEST_F(Failures, DifferentOptionsAreRefusedEverywhere) {
  LocalRanks ranks(3);
  std::atomic<int> refused = 0;
  ranks.run([&](Communicator& c) {
    FrameOptions frame{.width = 16, .height = 16};
    if (c.rank() == 1) frame.opacity = 0.5F;
    Renderer renderer(kSerialRank);
    try {
      (void)render_parts(c, renderer, {}, {}, Camera{.eye = {0, 0, 3}}, frame, {});
    } catch (const Error& e) {
      refused += std::string(e.what()).find("different cameras") != std::string::npos ? 1 : 0;
    }
  });
  EXPECT_EQ(refused, 3);
}

}  // namespace
}  // namespace rastrum::test::failures_test
