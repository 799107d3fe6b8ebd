// SPDX-License-Identifier: BSD-3-Clause
// The backends' loop: every index once, results visible afterwards, errors passed on.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>
#include <ostream>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scheduler.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/stop.hpp>

#include "tests/support/stop_trigger.hpp"

namespace rastrum::parallel::exec_test {
namespace {

#if defined(__SANITIZE_THREAD__)
constexpr bool kThreadSanitizer = true;
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
constexpr bool kThreadSanitizer = true;
#else
constexpr bool kThreadSanitizer = false;
#endif
#else
constexpr bool kThreadSanitizer = false;
#endif

template <class Exec>
void expect_each_index_once(Exec& exec, std::size_t n) {
  std::vector<int> calls(n, 0);
  for_each_index(exec, n, [&](std::size_t i) { ++calls[i]; });
  EXPECT_EQ(calls, std::vector<int>(n, 1));
}

/// As many threads of oneTBB, or of our own.
struct Team {
  int count;
  std::unique_ptr<Scheduler> (*make)(int count);
};
void PrintTo(const Team& team, std::ostream* out) {
  *out << team.count << (team.make == make_pool_scheduler ? " of the pool" : " of oneTBB");
}

class ThreadCounts : public testing::TestWithParam<Team> {
 protected:
  [[nodiscard]] static int count() { return GetParam().count; }
  Threads exec{GetParam().make(count())};
};

TEST(Serial, EachIndexOnce) {
  Serial exec;
  expect_each_index_once(exec, 0);
  expect_each_index_once(exec, 1000);
}

TEST_P(ThreadCounts, EachIndexOnce) {
  EXPECT_EQ(exec.concurrency(), count());
  for (const std::size_t n : {0U, 1U, 7U, 100000U}) expect_each_index_once(exec, n);
}

// Even on fewer cores: each body waits until all others have begun.
void expect_all_threads_at_once(Threads& exec, int count) {
  std::atomic<int> here = 0;
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(100);
  for_each_index(exec, static_cast<std::size_t>(count), [&](std::size_t) {
    ++here;
    while (here < count && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
    EXPECT_EQ(here, count);
  });
}

// Repeated, because oneTBB caches its limits.
TEST_P(ThreadCounts, AreThatManyThreads) {
  for (int repeat = 0; repeat < 3 && !HasFailure(); ++repeat) {
    Threads again(GetParam().make(count()));
    expect_all_threads_at_once(again, count());
  }
}

// Loops over the same memory, which other threads write each time, as in a frame's stages. Under
// the thread sanitizer this also tests that a loop is a barrier.
TEST_P(ThreadCounts, LoopsFollowEachOther) {
  constexpr std::size_t n = 10000;
  std::vector<std::size_t> a(n), b(n);
  for (std::size_t frame = 0; frame < 20; ++frame) {
    for_each_index(exec, n, [&](std::size_t i) { a[i] = i + frame; });
    for_each_index(exec, n, [&](std::size_t i) { b[i] = a[n - 1 - i]; });
    ASSERT_EQ(std::accumulate(b.begin(), b.end(), std::size_t{0}), n * (n - 1) / 2 + n * frame);
  }
}

TEST_P(ThreadCounts, NestedLoops) {
  std::atomic<int> calls = 0;
  for_each_index(exec, 30,
                 [&](std::size_t) { for_each_index(exec, 30, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls, 900);
}

TEST_P(ThreadCounts, AnErrorReachesTheCaller) {
  EXPECT_THROW(for_each_index(exec, 1000,
                              [](std::size_t i) {
                                if (i == 777) throw std::runtime_error("777");
                              }),
               std::runtime_error);
  expect_each_index_once(exec, 1000);
}

TEST_P(ThreadCounts, AStoppedLoopLeavesOutWhatHasNotBegun) {
  rastrum::test::StopTrigger trigger(9);
  const std::stop_token token = trigger.token();
  constexpr std::size_t n = 10000;
  {
    const StopScope scope(token);
    expect_each_index_once(exec, n);
    EXPECT_THROW(for_each_index(exec, n, [&](std::size_t) { trigger.call(); }), Stopped);
    // Each other thread may have begun one more.
    EXPECT_LE(trigger.after(), count() - 1);
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
  std::stop_source source;
  const std::stop_token token = source.get_token();
  const StopScope scope(token);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> asked = false;
  std::atomic<int> inner = 0;
  EXPECT_THROW(for_each_index(exec, 30,
                              [&](std::size_t) {
                                if (count() > 1 && std::this_thread::get_id() == caller) {
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

// As a server does whose requests share a renderer's threads.
TEST_P(ThreadCounts, SeveralCallersAtOnce) {
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> callers;
    for (int caller = 0; caller < 4; ++caller)
      callers.emplace_back([&] {
        for (std::size_t frame = 0; frame < 50; ++frame) {
          std::vector<std::size_t> squares(1000);
          for_each_index(exec, squares.size(), [&](std::size_t i) { squares[i] = i * i + frame; });
          for (std::size_t i = 0; i < squares.size(); ++i) wrong += squares[i] != i * i + frame;
        }
      });
  }
  EXPECT_EQ(wrong, 0);
}

TEST_P(ThreadCounts, OneOfManyErrorsReachesTheCaller) {
  for (int repeat = 0; repeat < 20; ++repeat)
    EXPECT_THROW(for_each_index(exec, 1000, [](std::size_t) { throw std::runtime_error("each"); }),
                 std::runtime_error);
  expect_each_index_once(exec, 1000);
}

// The caller pauses for longer than threads wait before they sleep, too.
TEST_P(ThreadCounts, AreWokenAfterAPause) {
  for (int repeat = 0; repeat < 3; ++repeat) {
    expect_all_threads_at_once(exec, count());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  expect_all_threads_at_once(exec, count());
}

INSTANTIATE_TEST_SUITE_P(Pool, ThreadCounts,
                         testing::Values(Team{1, make_pool_scheduler}, Team{2, make_pool_scheduler},
                                         Team{8, make_pool_scheduler}));
#if defined(RASTRUM_TBB)
INSTANTIATE_TEST_SUITE_P(Tbb, ThreadCounts,
                         testing::Values(Team{1, make_tbb_scheduler}, Team{2, make_tbb_scheduler},
                                         Team{8, make_tbb_scheduler}));
#endif

/// Runs `work` in a forked child, which has 30 seconds for it, and `meanwhile` in this process.
template <class Work, class Meanwhile>
void expect_done_in_child(const Work& work, const Meanwhile& meanwhile) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    alarm(30);  // ends a child that waits for threads that are not there
    work();
    _exit(testing::Test::HasFailure() ? 1 : 0);
  }
  meanwhile();
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

// Python's multiprocessing forks a process that has drawn. The child has no threads; it draws
// alone.
TEST(Pool, WorksAndEndsInAForkedChild) {
  if (kThreadSanitizer) GTEST_SKIP() << "the sanitizer starts no threads after a fork";
  auto exec = std::make_unique<Threads>(make_pool_scheduler(4));
  expect_all_threads_at_once(*exec, 4);
  expect_done_in_child(
      [&] {
        expect_each_index_once(*exec, 1000);
        exec = std::make_unique<Threads>(make_pool_scheduler(4));  // which has threads again
        expect_all_threads_at_once(*exec, 4);
        exec.reset();
      },
      [&] { expect_each_index_once(*exec, 1000); });
}

// The parent's threads hold oneTBB's locks now and then, also while they go to sleep.
TEST(Threads, AreOfThePoolInAForkedChild) {
  if (kThreadSanitizer) GTEST_SKIP() << "the sanitizer starts no threads after a fork";
  auto exec = std::make_unique<Threads>(4);
  for (int i = 0; i < 50 && !HasFailure(); ++i) {
    expect_all_threads_at_once(*exec, 4);
    expect_done_in_child(
        [&] {
          expect_all_threads_at_once(*std::make_unique<Threads>(4), 4);
          expect_each_index_once(*exec, 1000);
          exec.reset();
        },
        [] {});
  }
}

TEST(Turns, BeginInAChildThatIsForkedWhileThreadsTakeSome) {
  if (kThreadSanitizer) GTEST_SKIP() << "the sanitizer sees no locks of a forked child";
  std::mutex mine, others;
  std::atomic<bool> done = false;
  std::jthread busy([&] {
    while (!done) const CallingTurn turn(others, {});
  });
  for (int i = 0; i < 50 && !HasFailure(); ++i)
    expect_done_in_child([&] { const CallingTurn turn(mine, {}); }, [] {});
  done = true;
}

}  // namespace
}  // namespace rastrum::parallel::exec_test
