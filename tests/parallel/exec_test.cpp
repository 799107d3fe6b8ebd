// SPDX-License-Identifier: BSD-3-Clause
// The backends' loop: every index once, results visible afterwards, errors passed on.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/stop.hpp>

#include "tests/support/stop_trigger.hpp"

namespace rastrum::parallel::exec_test {
namespace {

template <class Exec>
void expect_each_index_once(Exec& exec, std::size_t n) {
  std::vector<int> calls(n, 0);
  for_each_index(exec, n, [&](std::size_t i) { ++calls[i]; });
  EXPECT_EQ(calls, std::vector<int>(n, 1));
}

class ThreadCounts : public testing::TestWithParam<int> {};

TEST(Serial, EachIndexOnce) {
  Serial exec;
  expect_each_index_once(exec, 0);
  expect_each_index_once(exec, 1000);
}

TEST_P(ThreadCounts, EachIndexOnce) {
  Threads exec(GetParam());
  EXPECT_EQ(exec.concurrency(), GetParam());
  for (const std::size_t n : {0U, 1U, 7U, 100000U}) expect_each_index_once(exec, n);
}

// Even on fewer cores: each body waits until all others have begun. Repeated, because oneTBB caches
// its limits.
TEST_P(ThreadCounts, AreThatManyThreads) {
  for (int repeat = 0; repeat < 3; ++repeat) {
    Threads exec(GetParam());
    std::atomic<int> here = 0;
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    for_each_index(exec, static_cast<std::size_t>(GetParam()), [&](std::size_t) {
      ++here;
      while (here < GetParam() && std::chrono::steady_clock::now() < patience)
        std::this_thread::yield();
      EXPECT_EQ(here, GetParam());
    });
    if (HasFailure()) return;
  }
}

// Loops over the same memory, which other threads write each time, as in a frame's stages. Under
// the thread sanitizer this also tests that a loop is a barrier.
TEST_P(ThreadCounts, LoopsFollowEachOther) {
  Threads exec(GetParam());
  constexpr std::size_t n = 10000;
  std::vector<std::size_t> a(n), b(n);
  for (std::size_t frame = 0; frame < 20; ++frame) {
    for_each_index(exec, n, [&](std::size_t i) { a[i] = i + frame; });
    for_each_index(exec, n, [&](std::size_t i) { b[i] = a[n - 1 - i]; });
    ASSERT_EQ(std::accumulate(b.begin(), b.end(), std::size_t{0}), n * (n - 1) / 2 + n * frame);
  }
}

TEST_P(ThreadCounts, NestedLoops) {
  Threads exec(GetParam());
  std::atomic<int> calls = 0;
  for_each_index(exec, 30,
                 [&](std::size_t) { for_each_index(exec, 30, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls, 900);
}

TEST_P(ThreadCounts, AnErrorReachesTheCaller) {
  Threads exec(GetParam());
  EXPECT_THROW(for_each_index(exec, 1000,
                              [](std::size_t i) {
                                if (i == 777) throw std::runtime_error("777");
                              }),
               std::runtime_error);
  expect_each_index_once(exec, 1000);
}

TEST_P(ThreadCounts, AStoppedLoopLeavesOutWhatHasNotBegun) {
  Threads exec(GetParam());
  rastrum::test::StopTrigger trigger(9);
  const std::stop_token token = trigger.token();
  constexpr std::size_t n = 10000;
  {
    const StopScope scope(token);
    expect_each_index_once(exec, n);
    EXPECT_THROW(for_each_index(exec, n, [&](std::size_t) { trigger.call(); }), Stopped);
    // Each other thread may have begun one more.
    EXPECT_LE(trigger.after(), GetParam() - 1);
    EXPECT_THROW(for_each_index(exec, 1, [](std::size_t) {}), Stopped);
    {
      const StopScope none(nullptr);
      expect_each_index_once(exec, n);
    }
    EXPECT_TRUE(stop_requested());
  }
  EXPECT_FALSE(stop_requested());
  expect_each_index_once(exec, n);
}

// A worker, if there is one, requests the stop; the caller has the token anyway.
TEST_P(ThreadCounts, BodiesAndTheirLoopsSeeTheStop) {
  Threads exec(GetParam());
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const StopScope scope(token);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> asked = false;
  std::atomic<int> inner = 0;
  EXPECT_THROW(for_each_index(exec, 30,
                              [&](std::size_t) {
                                if (GetParam() > 1 && std::this_thread::get_id() == caller) {
                                  asked.wait(false);
                                } else {
                                  source.request_stop();
                                  asked = true;
                                  asked.notify_all();
                                }
                                EXPECT_TRUE(stop_requested());
                                for_each_index(exec, 30, [&](std::size_t) { ++inner; });
                              }),
               Stopped);
  EXPECT_EQ(inner, 0);
}

INSTANTIATE_TEST_SUITE_P(Counts, ThreadCounts, testing::Values(1, 2, 8));

}  // namespace
}  // namespace rastrum::parallel::exec_test
