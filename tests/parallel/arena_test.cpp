// SPDX-License-Identifier: BSD-3-Clause
// The words' memory is reused, bounded by its peak use, and accounted.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tests/parallel/backends.hpp"

#include <rastrum/error.hpp>

#include "tests/support/refused.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::parallel::test::arena_test {
namespace {

#if defined(__has_feature)
constexpr bool kKeeps = !__has_feature(address_sanitizer);
#elif defined(__SANITIZE_ADDRESS__)
constexpr bool kKeeps = false;
#else
constexpr bool kKeeps = true;
#endif

constexpr std::size_t kMiB = std::size_t{1} << 20;

TEST(Arena, HandsOutAlignedBlocksOfTheirOwn) {
  Arena arena;
  std::vector<std::pair<std::uint8_t*, std::size_t>> blocks;
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{65},
                                  std::size_t{100000}, 3 * kMiB, 5 * kMiB + 1}) {
    auto* const p = static_cast<std::uint8_t*>(arena.allocate(bytes));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(p) % 64, 0U);
    std::fill_n(p, bytes, static_cast<std::uint8_t>(blocks.size() + 1));
    blocks.emplace_back(p, bytes);
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_TRUE(std::all_of(blocks[i].first, blocks[i].first + blocks[i].second,
                            [&](std::uint8_t b) { return b == i + 1; }));
    arena.release(blocks[i].first, blocks[i].second);
  }
  EXPECT_EQ(arena.in_use(), 0U);
}

TEST(Arena, KeepsWhatComesBackAndNoMoreThanWasOut) {
  if (!kKeeps) GTEST_SKIP() << "the address sanitizer is to see what is used after its release";
  MemoryAccount account;
  Arena arena(&account);
  void* const a = arena.allocate(kMiB);
  arena.release(a, kMiB);
  EXPECT_EQ(arena.held(), kMiB);
  EXPECT_EQ(arena.allocate(kMiB), a);
  arena.release(a, kMiB);

  // Blocks of growing size, one at a time: old ones must be freed.
  for (std::size_t bytes = kMiB; bytes <= 40 * kMiB; bytes = bytes / 4 * 5) {
    arena.release(arena.allocate(bytes), bytes);
    ASSERT_LE(arena.held(), arena.peak());
    ASSERT_GE(arena.peak(), bytes);
    ASSERT_LE(arena.peak(), bytes / 4 * 5 + 64);
  }
  EXPECT_EQ(account.peak(), arena.peak());
  arena.trim();
  EXPECT_EQ(arena.held(), 0U);
}

TEST(Arena, SaysWhatWasAskedForWhenThereIsNone) {
  Arena arena;
  for (const std::size_t bytes : {SIZE_MAX, SIZE_MAX / 2 - 5})
    rastrum::test::expect_refused(std::to_string(bytes), Errc::out_of_memory,
                                  [&] { static_cast<void>(arena.allocate(bytes)); });
  EXPECT_EQ(arena.in_use(), 0U);
}

/// A source of memory with `left` blocks, or one that fails for another reason.
int left = 0;
bool faults = false;
MemorySource source_that_ends() {
  MemorySource source = host_memory();
  source.allocate = [](std::size_t bytes) -> void* {
    if (left-- > 0) return host_memory().allocate(bytes);
    if (faults) throw Error(Errc::no_device, "the device is gone");
    return nullptr;
  };
  source.name = "device memory";
  source.keeps_all = true;
  return source;
}

TEST(Arena, TellsLackOfMemoryFromAFaultOfItsSource) {
  for (const bool fault : {false, true})
    for (int n = 0; n < 4; ++n) {
      MemoryAccount account;
      Arena arena(&account, source_that_ends());
      left = n;
      faults = fault;
      std::vector<void*> blocks;
      rastrum::test::expect_refused(fault ? "device is gone" : "of device memory",
                                    fault ? Errc::no_device : Errc::out_of_memory, [&] {
                                      for (;;) blocks.push_back(arena.allocate(kMiB));
                                    });
      ASSERT_EQ(blocks.size(), static_cast<std::size_t>(n));
      EXPECT_EQ(arena.in_use(), blocks.size() * kMiB);
      // With a kept block that is too small, the source is asked again; nothing is lost.
      for (void* const block : blocks) arena.release(block, kMiB);
      EXPECT_THROW(static_cast<void>(arena.allocate(2 * kMiB)), Error);
      left = 1;
      arena.release(arena.allocate(2 * kMiB), 2 * kMiB);
      arena.trim();
      EXPECT_EQ(account.held(), 0U);
    }
}

// A moving camera changes the sizes of a frame's lists, and allocation on a device stalls it.
TEST(Arena, SizesThatDriftTakeBlocksThatAreThere) {
  const auto frames = static_cast<std::size_t>(rastrum::test::share_of(300, 60));
  constexpr std::size_t kLists = 6;
  constexpr std::size_t kSmallest = 100000;
  static int asked = 0;
  asked = 0;
  MemorySource source = host_memory();
  source.allocate = [](std::size_t bytes) -> void* {
    ++asked;
    return host_memory().allocate(bytes);
  };
  source.keeps_all = true;
  Arena arena(nullptr, source);
  const auto sizes = random_values<std::uint32_t>(frames * kLists, 9 * kSmallest);
  int after_half = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (frame == frames / 2) after_half = asked;
    std::vector<std::pair<void*, std::size_t>> lists;
    for (std::size_t list = 0; list < kLists; ++list) {
      const std::size_t bytes = kSmallest + sizes[frame * kLists + list];
      lists.emplace_back(arena.allocate(bytes), bytes);
      std::memset(lists.back().first, static_cast<int>(list), bytes);
    }
    for (const auto& [block, bytes] : lists) {
      const auto* const first = static_cast<const std::uint8_t*>(block);
      ASSERT_TRUE(std::all_of(first, first + bytes, [&](std::uint8_t b) { return b == *first; }));
      arena.release(block, bytes);
    }
    ASSERT_EQ(arena.in_use(), 0U);
  }
  EXPECT_EQ(asked, after_half) << "new blocks in the second half";
  EXPECT_LE(asked, 4 * static_cast<int>(kLists));
  EXPECT_LE(arena.held(), 2 * arena.peak());
}

TEST(Arena, BuffersOutliveTheirBackend) {
  MemoryAccount account;
  Buffer<std::uint32_t> kept;
  {
    Threads exec(2, &account);
    kept =
        filter(exec, counting<std::uint32_t>(100000), [](std::uint32_t i) { return i % 2 == 0; });
  }
  EXPECT_GE(account.peak(), 50000U * sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < 50000; ++i) ASSERT_EQ(kept[i], 2 * i);
  kept = Buffer<std::uint32_t>();
  account.restart_peak();
  EXPECT_EQ(account.peak(), 0U);
}

TEST(Arena, FramesAfterTheFirstTakeNothingNew) {
  if (!kKeeps) GTEST_SKIP() << "the address sanitizer is to see what is used after its release";
  MemoryAccount account;
  Threads exec(1, &account);  // with more, the threads of a frame may vary
  std::uint64_t after_the_first = 0;
  for (int frame = 0; frame < 5; ++frame) {
    auto keys = random_values<std::uint32_t>(300007, 1000);
    auto values = keys;
    sort_by_key(exec, keys, values);
    const auto reduced = reduce_by_key(exec, keys, values);
    const auto odd = filter(exec, reduced.keys, [](std::uint32_t k) { return k % 2 == 1; });
    EXPECT_EQ(odd.size(), 500U);
    if (frame == 0) after_the_first = account.peak();
  }
  EXPECT_GT(after_the_first, 300007U * 8);
  EXPECT_EQ(account.peak(), after_the_first);
}

}  // namespace
}  // namespace rastrum::parallel::test::arena_test
