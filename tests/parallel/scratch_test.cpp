// SPDX-License-Identifier: BSD-3-Clause
// for_each_with_scratch: every index once, no scratch in two bodies at a time, memory kept.
#include <atomic>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::scratch_test {
namespace {

struct Scratch {
  std::vector<std::size_t> seen;
  std::atomic<int> users = 0;
};

TEST(Scratch, GivesEachBodyOneOfItsOwn) {
  constexpr std::size_t n = 20000;
  on_every_backend([&](auto& exec) {
    ScratchPool<Scratch> pool;
    std::atomic<int> shared = 0;
    for (int frame = 0; frame < 3; ++frame)
      for_each_with_scratch(exec, n, pool, [&](std::size_t i, Scratch& scratch) {
        if (++scratch.users != 1) ++shared;
        scratch.seen.push_back(i);
        --scratch.users;
      });
    EXPECT_EQ(shared, 0);
    std::vector<int> calls(n, 0);
    int made = 0;
    pool.for_each([&](Scratch& scratch) {
      ++made;
      for (const std::size_t i : scratch.seen) ++calls[i];
    });
    EXPECT_EQ(calls, std::vector<int>(n, 3));
    EXPECT_GE(made, 1);
    EXPECT_LE(made, 8);
  });
}

TEST(Scratch, IsMadeByTheFactoryOnceAThread) {
  on_every_backend([&](auto& exec) {
    std::atomic<int> made = 0;
    ScratchPool<std::vector<int>> pool([&] {
      ++made;
      return std::vector<int>(5, 7);
    });
    std::atomic<int> wrong = 0;
    for (int frame = 0; frame < 5; ++frame)
      for_each_with_scratch(exec, 1000, pool, [&](std::size_t, std::vector<int>& scratch) {
        if (scratch != std::vector<int>(5, 7)) ++wrong;
      });
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(made, exec.concurrency());
    int kept = 0;
    pool.for_each([&](std::vector<int>&) { ++kept; });
    EXPECT_EQ(kept, made);
  });
}

}  // namespace
}  // namespace rastrum::parallel::test::scratch_test
