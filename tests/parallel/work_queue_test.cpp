// WorkQueue: each item once, whoever pushes and pops; work that makes work ends when all is done.
#include <algorithm>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>

#include <tests/parallel/backends.hpp>

namespace rastrum::parallel::test {
namespace {

TEST(WorkQueue, GivesEachItemOnceInChunks) {
  WorkQueue<int> queue(10);
  std::vector<int> items(105);
  std::iota(items.begin(), items.end(), 0);
  queue.push(items);
  queue.push(105);
  EXPECT_EQ(queue.size(), 106U);
  std::vector<int> seen, chunk;
  int chunks = 0;
  while (queue.try_pop(chunk)) {
    EXPECT_LE(chunk.size(), 10U);
    seen.insert(seen.end(), chunk.begin(), chunk.end());
    ++chunks;
  }
  EXPECT_EQ(chunks, 11);
  EXPECT_TRUE(chunk.empty());
  EXPECT_EQ(queue.size(), 0U);
  std::ranges::sort(seen);
  items.push_back(105);
  EXPECT_EQ(seen, items);
}

TEST(WorkQueue, ManyProducersAndConsumersLoseNothing) {
  constexpr std::size_t kProducers = 4, kItems = 20000;
  WorkQueue<std::size_t> queue(16);
  std::atomic<std::size_t> taken = 0;
  std::vector<std::atomic<int>> seen(kProducers * kItems);
  std::vector<std::jthread> threads;
  for (std::size_t p = 0; p < kProducers; ++p)
    threads.emplace_back([&, p] {
      for (std::size_t i = 0; i < kItems; ++i) queue.push(p * kItems + i);
    });
  for (int c = 0; c < 4; ++c)
    threads.emplace_back([&] {
      std::vector<std::size_t> chunk;
      while (taken < kProducers * kItems) {
        if (!queue.try_pop(chunk)) {
          std::this_thread::yield();
          continue;
        }
        for (const std::size_t i : chunk) ++seen[i];
        taken += chunk.size();
      }
    });
  threads.clear();
  EXPECT_TRUE(std::ranges::all_of(seen, [](const std::atomic<int>& n) { return n == 1; }));
}

// A binary tree, grown by the work itself: far more items than were there at the beginning.
TEST(WorkQueue, WorkThatMakesWorkIsAllDone) {
  constexpr std::size_t kNodes = 100000;
  on_every_backend([&](auto& exec) {
    WorkQueue<std::size_t> queue(8);
    queue.push(1);
    std::vector<std::atomic<int>> visits(kNodes + 1);
    std::atomic<int> bad_workers = 0;
    queue.work_off(exec, [&](std::size_t worker, std::span<const std::size_t> chunk, auto& more) {
      if (worker >= static_cast<std::size_t>(exec.concurrency())) ++bad_workers;
      for (const std::size_t node : chunk) {
        ++visits[node];
        for (const std::size_t child : {2 * node, 2 * node + 1})
          if (child <= kNodes) more.push(child);
      }
    });
    EXPECT_EQ(visits[0], 0);
    EXPECT_TRUE(std::all_of(visits.begin() + 1, visits.end(),
                            [](const std::atomic<int>& n) { return n == 1; }));
    EXPECT_EQ(bad_workers, 0);
  });
}

TEST(WorkQueue, NothingToDoEndsAtOnce) {
  on_every_backend([&](auto& exec) {
    WorkQueue<int> queue;
    queue.work_off(exec, [](std::size_t, std::span<const int>, auto&) { FAIL(); });
  });
}

TEST(WorkQueue, AnErrorReachesTheCaller) {
  on_every_backend([&](auto& exec) {
    WorkQueue<int> queue(1);
    for (int i = 0; i < 100; ++i) queue.push(i);
    EXPECT_THROW(queue.work_off(exec,
                                [](std::size_t, std::span<const int> chunk, auto&) {
                                  if (chunk[0] == 50) throw std::runtime_error("50");
                                }),
                 std::runtime_error);
  });
}

}  // namespace
}  // namespace rastrum::parallel::test
