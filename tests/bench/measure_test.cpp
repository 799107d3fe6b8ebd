// SPDX-License-Identifier: BSD-3-Clause
// Interleaved timing: the order of turns, and the statistics.
#include <bench/measure.hpp>

#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace rastrum::bench::measure_test {
namespace {

TEST(Measure, MedianTakesTheMiddleOrTheMeanOfTwo) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(median({5}), 5);
  EXPECT_EQ(median({9, 1, 5}), 5);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(Measure, SpreadIsHalfTheQuartilesDistanceOverTheMedian) {
  const Timing timing{"", {1, 2, 3, 4, 5}, {}};
  EXPECT_DOUBLE_EQ(timing.median_ms(), 3);
  EXPECT_DOUBLE_EQ(timing.spread(), (4.0 - 2.0) / 2 / 3);
}

TEST(Measure, RatioIsTakenRoundByRound) {
  // The machine slows down between rounds and disturbs `b` once. The ratio of the medians would be
  // 2.
  const Timing a{"a", {10, 20, 60}, {}};
  const Timing b{"b", {2, 10, 12}, {}};
  EXPECT_DOUBLE_EQ(median_ratio(a, b), 5);
}

TEST(Measure, TurnsAlternate) {
  std::string order;
  const auto frame = [&order](char name) {
    return [&order, name] {
      if (order.empty() || order.back() != name) order += name;
    };
  };
  const Contender contenders[] = {{"A", frame('A')}, {"B", frame('B')}, {"C", frame('C')}};
  const auto timings = measure_interleaved(contenders, {.rounds = 3, .turn_ms = 0.1});
  EXPECT_EQ(order, "ABCABCABCABC");  // the first three measure the length of a frame
  ASSERT_EQ(timings.size(), 3U);
  for (const Timing& t : timings) EXPECT_EQ(t.samples_ms.size(), 3U);
  EXPECT_EQ(timings[1].name, "B");
}

TEST(Measure, SlowFramesAreNotWarmedUp) {
  int fast = 0, slow = 0;
  const Contender contenders[] = {
      {"fast", [&] { ++fast; }},
      {"slow",
       [&] {
         ++slow;
         std::this_thread::sleep_for(std::chrono::milliseconds(10));
       }},
  };
  const auto timings = measure_interleaved(contenders, {.rounds = 2, .turn_ms = 1});
  EXPECT_EQ(slow, 1 + 2);
  EXPECT_GE(fast, 1 + 2 * 2);
  EXPECT_GE(timings[1].median_ms(), 10);
  ASSERT_EQ(timings[1].cpu_samples_ms.size(), 2U);
  EXPECT_LT(timings[1].cpu_samples_ms[0], 9);  // it sleeps
  EXPECT_LT(timings[0].median_ms(), 1);
}

}  // namespace
}  // namespace rastrum::bench::measure_test
