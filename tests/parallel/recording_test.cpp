// SPDX-License-Identifier: BSD-3-Clause
// Loops in order, and recordings: all tasks once, with consistent times.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/recording.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::parallel::recording_test {
namespace {

TEST(ForEachInOrder, EachIndexOnceAndBegunInOrder) {
  for (const int count : {1, 2, 5}) {
    Threads exec(count);
    for (const std::size_t n : {0U, 1U, 3U, 5000U}) {
      std::vector<int> calls(n, 0);
      std::atomic<std::size_t> begun = 0;
      for_each_in_order(exec, n, [&](std::size_t i) {
        ++calls[i];
        // Each thread may hold one index that it took earlier.
        EXPECT_LE(i, begun.fetch_add(1) + static_cast<std::size_t>(count));
      });
      EXPECT_EQ(calls, std::vector<int>(n, 1));
    }
  }
}

TEST(ForEachInOrder, ErrorsAndStopsEndIt) {
  Threads exec(3);
  EXPECT_THROW(for_each_in_order(exec, 100,
                                 [](std::size_t i) {
                                   if (i == 7) throw std::runtime_error("seven");
                                 }),
               std::runtime_error);
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const StopScope scope(token);
  std::atomic<int> calls = 0;
  EXPECT_THROW(for_each_in_order(exec, 100'000,
                                 [&](std::size_t i) {
                                   ++calls;
                                   if (i == 5) source.request_stop();
                                 }),
               Stopped);
  EXPECT_LT(calls, 100'000);
}

void spin() {
  const std::int64_t end = Recording::now_ns() + 2000;
  while (Recording::now_ns() < end) {
  }
}

/// Expects each index of the loop as one task within the loop's time.
void expect_whole(const Recording::Loop& loop) {
  std::vector<int> found(loop.n, 0);
  for (const Recording::Task& task : loop.tasks) {
    EXPECT_LE(task.end - task.begin, loop.grain);
    EXPECT_LE(loop.begin_ns, task.begin_ns);
    EXPECT_LE(task.begin_ns, task.end_ns);
    EXPECT_LE(task.end_ns, loop.end_ns);
    for (std::size_t i = task.begin; i < task.end; ++i) ++found[i];
  }
  EXPECT_EQ(found, std::vector<int>(loop.n, 1));
}

TEST(Recording, HoldsAllTasksOfAllLoops) {
  for (const int count : {1, 3}) {
    Threads exec(count);
    Recording recording;
    {
      const RecordScope scope(recording);
      for_each_index(exec, 100, [](std::size_t) { spin(); });
      for_each_index(
          exec, 100, [](std::size_t) { spin(); }, 8);
      for_each_in_order(exec, 50, [](std::size_t) { spin(); });
      for_each_index(exec, 0, [](std::size_t) {});
    }
    for_each_index(exec, 100, [](std::size_t) {});
    ASSERT_EQ(recording.loops.size(), 4U);
    for (const Recording::Loop& loop : recording.loops) expect_whole(loop);
    EXPECT_EQ(recording.loops[0].tasks.size(), 100U);
    EXPECT_EQ(recording.loops[1].grain, 8U);
    EXPECT_TRUE(recording.loops[2].in_order);
    for (std::size_t l = 1; l < 4; ++l)
      EXPECT_LE(recording.loops[l - 1].end_ns, recording.loops[l].begin_ns);
    if (count > 1) continue;
    // On one thread tasks do not overlap.
    for (const Recording::Loop& loop : recording.loops) {
      std::int64_t at = loop.begin_ns;
      for (const Recording::Task& task : loop.tasks) {
        EXPECT_LE(at, task.begin_ns);
        at = task.end_ns;
        EXPECT_GE(task.end_ns - task.begin_ns,
                  2000 * static_cast<std::int64_t>(task.end - task.begin));
      }
    }
  }
}

TEST(Recording, ALoopWithinABodyIsPartOfIt) {
  Threads exec(2);
  Recording recording;
  const RecordScope scope(recording);
  for_each_index(exec, 3, [&](std::size_t) { for_each_index(exec, 10, [](std::size_t) {}); });
  ASSERT_EQ(recording.loops.size(), 1U);
  expect_whole(recording.loops[0]);
  EXPECT_EQ(RecordScope::current(), &recording);
}

TEST(Recording, PretendsToHaveWorkers) {
  Threads exec(1);
  Recording recording;
  recording.workers = 64;
  {
    const RecordScope scope(recording);
    EXPECT_EQ(exec.concurrency(), 64);
    for_each_index(exec, 1, [&](std::size_t) { EXPECT_EQ(exec.concurrency(), 64); });
  }
  EXPECT_EQ(exec.concurrency(), 1);
}

}  // namespace
}  // namespace rastrum::parallel::recording_test
