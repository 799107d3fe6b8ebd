// SPDX-License-Identifier: BSD-3-Clause
// WorkQueue: each item is popped once, with any threads.
#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::work_queue_test {
namespace {

TEST(WorkQueue, GivesEachItemOnceInChunks) {
  WorkQueue<int> queue(10);
  std::vector<int> items(105);
  std::iota(items.begin(), items.end(), 0);
  queue.push(items);
  queue.push(105);
  std::vector<int> seen, chunk;
  int chunks = 0;
  while (queue.try_pop(chunk)) {
    EXPECT_LE(chunk.size(), 10U);
    seen.insert(seen.end(), chunk.begin(), chunk.end());
    ++chunks;
  }
  EXPECT_EQ(chunks, 11);
  EXPECT_TRUE(chunk.empty());
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

}  // namespace
}  // namespace rastrum::parallel::test::work_queue_test
