// SPDX-License-Identifier: BSD-3-Clause
// Ranks on threads: tests each function of a Communicator, the exact count of sent bytes, and that
// a leaving rank ends the others' waiting.
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks.hpp>

#include "tests/support/refused.hpp"

namespace rastrum::test::local_ranks_test {
namespace {

std::uint64_t number_of(int rank) {
  return static_cast<std::uint64_t>(rank);
}

TEST(LocalRanks, ExchangeWhatTheySay) {
  for (const int n : {1, 2, 7}) {
    LocalRanks ranks(n);
    ranks.run([n](Communicator& c) {
      const auto size = static_cast<std::size_t>(n);
      const std::uint64_t me = number_of(c.rank());
      ASSERT_EQ(c.size(), n);
      EXPECT_EQ(c.max(10 + me), 9 + number_of(n));
      std::uint32_t told = c.rank() == n - 1 ? 77 : 0;
      c.broadcast(std::as_writable_bytes(std::span(&told, 1)), n - 1);
      EXPECT_EQ(told, 77U);

      // Rank r sends r bytes of its number to each rank but the first.
      std::vector<std::uint64_t> to(size, me), from(size);
      to[0] = 0;
      c.exchange_sizes(to, from);
      std::vector<std::vector<std::byte>> out(size), in(size);
      std::vector<std::span<const std::byte>> out_views(size);
      std::vector<std::span<std::byte>> in_views(size);
      for (std::size_t r = 0; r < size; ++r) {
        EXPECT_EQ(from[r], c.rank() == 0 ? 0 : r);
        out[r].assign(to[r], std::byte(me));
        in[r].resize(from[r]);
        out_views[r] = out[r];
        in_views[r] = in[r];
      }
      c.exchange(out_views, in_views);
      for (std::size_t r = 0; r < size; ++r)
        for (const std::byte b : in[r]) EXPECT_EQ(b, std::byte(r));
    });
  }
}

TEST(LocalRanks, CountWhatTheySendToOthers) {
  LocalRanks ranks(3);
  ranks.run([](Communicator& c) {
    const std::vector<std::byte> five(5);
    std::vector<std::byte> room(5);
    std::vector<std::span<const std::byte>> to(3);
    std::vector<std::span<std::byte>> from(3);
    if (c.rank() == 0) to[0] = to[2] = five;
    if (c.rank() == 0 || c.rank() == 2) from[0] = room;
    c.exchange(to, from);
  });
  EXPECT_EQ(ranks.traffic()[0].bytes, 5U);
  EXPECT_EQ(ranks.traffic()[0].messages, 1U);
  EXPECT_EQ(ranks.traffic()[2].messages, 0U);
}

TEST(LocalRanks, CountRoundsOfAgreements) {
  for (const auto& [n, rounds] : {std::pair{1, 0U}, {2, 1U}, {3, 2U}, {8, 3U}, {9, 4U}}) {
    LocalRanks ranks(n);
    ranks.run([](Communicator& c) {
      (void)c.max(1);
      std::array<std::byte, 5> told{};
      c.broadcast(told, 0);
    });
    EXPECT_EQ(ranks.traffic()[0].messages, 2 * rounds);
    EXPECT_EQ(ranks.traffic()[0].bytes, (8 + 5) * rounds);
    EXPECT_EQ(ranks.traffic().back().messages, (n == 1 ? 0 : 1) * rounds);
  }
}

TEST(LocalRanks, AgreeOnManyNumbers) {
  LocalRanks ranks(5);
  ranks.run([](Communicator& c) {
    std::vector<std::uint64_t> values(19);  // enough for several exchanges
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = i % 5 == number_of(c.rank()) ? 100 + i : i;
    c.max_of_each(values);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], 100 + i);
  });
}

/// After an agreement all ranks see at one address what each has written. Growing keeps the
/// memory's contents.
TEST(LocalRanks, OfOneNodeShareMemory) {
  for (const int node : {0, 5, 9}) {
    LocalRanks ranks(5, node);
    std::vector<std::uint64_t*> places(5);
    std::size_t before = 0;
    for (const std::size_t count : {5U, 1000U, 20U}) {
      ranks.run([&](Communicator& c) {
        const std::size_t me = number_of(c.rank());
        const auto memory = c.share(count);
        EXPECT_GE(memory.size(), count);
        if (before != 0) {
          EXPECT_EQ(memory[me], before * 10 + me);
        }
        places[me] = memory.data();
        memory[me] = count * 10 + me;
        (void)c.max(0);
        for (std::size_t r = 0; r < 5; ++r) {
          EXPECT_EQ(memory[r], count * 10 + r);
          EXPECT_EQ(places[r], memory.data());
        }
      });
      before = count;
    }
  }
}

TEST(LocalRanks, OfSeveralNodesShareNone) {
  for (const int node : {1, 2, 4}) {
    LocalRanks ranks(5, node);
    ranks.run([](Communicator& c) { EXPECT_TRUE(c.share(8).empty()); });
  }
}

/// A request for too much fails on all ranks, and existing memory stays.
TEST(LocalRanks, WithoutMemoryShareNone) {
  LocalRanks ranks(3);
  ranks.run([](Communicator& c) {
    // More than a vector can have, because sanitizers end the program if less is not available.
    EXPECT_TRUE(c.share(~std::size_t{0} / 8).empty());
    EXPECT_TRUE(c.share(~std::size_t{0}).empty());
    EXPECT_EQ(c.share(7).size(), 7U);
  });
}

TEST(LocalRanks, ARankThatLeavesEndsTheWaiting) {
  LocalRanks ranks(4);
  for (int i = 0; i < 200; ++i) {
    expect_refused("gone", Errc::not_found, [&] {
      ranks.run([](Communicator& c) {
        (void)c.max(1);
        if (c.rank() == 2) throw Error(Errc::not_found, "gone");
        (void)c.max(2);
        ADD_FAILURE() << "nobody comes here";
      });
    });
  }
  ranks.run([](Communicator& c) { EXPECT_EQ(c.max(number_of(c.rank())), 3U); });
}

TEST(LocalRanks, HaveANumber) {
  expect_refused("not 0", [] { LocalRanks ranks(0); });
  expect_refused("4097", [] { LocalRanks ranks(4097); });
  expect_refused("not -1", [] { LocalRanks ranks(2, -1); });
}

}  // namespace
}  // namespace rastrum::test::local_ranks_test
