// SPDX-License-Identifier: BSD-3-Clause
// The order of tasks: all items once, large ones first and alone, small ones in order.
#include <rastrum/raster/bin/load_order.hpp>

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace rastrum::raster::load_order_test {
namespace {

std::vector<std::vector<std::uint32_t>> tasks_of(const std::vector<std::uint64_t>& loads,
                                                 int threads) {
  LoadOrder order;
  order.arrange(loads, threads);
  std::vector<std::vector<std::uint32_t>> tasks;
  for (std::size_t i = 0; i < order.tasks(); ++i)
    tasks.emplace_back(order.task(i).begin(), order.task(i).end());
  return tasks;
}

using Tasks = std::vector<std::vector<std::uint32_t>>;

TEST(LoadOrder, OneThreadGoesInOrder) {
  EXPECT_EQ(tasks_of({1, 100, 5}, 1), (Tasks{{0}, {1}, {2}}));
  EXPECT_TRUE(tasks_of({}, 1).empty());
  EXPECT_TRUE(tasks_of({}, 8).empty());
}

TEST(LoadOrder, LargeOnesComeFirstByPowersOfTwo) {
  // A share is 102, so more than 12 is large; 40, 33 and 60 have the same number of digits.
  EXPECT_EQ(tasks_of({40, 3, 100, 33, 5, 60, 167}, 4), (Tasks{{6}, {2}, {0}, {3}, {5}, {1}, {4}}));
}

TEST(LoadOrder, SmallOnesGoTogether) {
  // A share is 320 / 2, so small means at most 20, and 5 tasks are enough.
  std::vector<std::uint64_t> loads(20, 1);
  loads.push_back(300);
  const Tasks tasks = tasks_of(loads, 2);
  ASSERT_EQ(tasks.size(), 5U);
  EXPECT_EQ(tasks[0], (std::vector<std::uint32_t>{20}));
  EXPECT_EQ(tasks[1], (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(tasks[4], (std::vector<std::uint32_t>{15, 16, 17, 18, 19}));
}

TEST(LoadOrder, EachItemOnce) {
  std::vector<std::uint64_t> loads;
  for (std::uint64_t i = 0; i < 1000; ++i) loads.push_back(i * 7919 % 1013 << i % 9);
  for (const int threads : {1, 2, 16, 64, 256}) {
    std::vector<int> found(loads.size(), 0);
    for (const auto& task : tasks_of(loads, threads)) {
      EXPECT_FALSE(task.empty());
      for (const std::uint32_t i : task) ++found[i];
    }
    EXPECT_EQ(found, std::vector<int>(loads.size(), 1)) << threads;
  }
}

}  // namespace
}  // namespace rastrum::raster::load_order_test
