// SPDX-License-Identifier: BSD-3-Clause
// Messages in two hops: each pair of ranks has a rank between that both know. Pictures take fewer
// messages for the same bits (deals.hpp compares those).
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks/hops.hpp>

#include "tests/ranks/deals.hpp"

namespace rastrum::test::hops_test {
namespace {

bool has(const std::vector<std::size_t>& ranks, std::size_t r) {
  return std::ranges::count(ranks, r) == 1;
}

TEST(HopGrid, WhoIsBetweenKnowsBoth) {
  for (std::size_t n = 1; n < 80; ++n) {
    const ranks::HopGrid grid(n);
    for (std::size_t from = 0; from < n; ++from) {
      // Senders and receivers agree, so nobody waits for a rank that does not send.
      for (const std::size_t peer : grid.first_to(from))
        ASSERT_TRUE(has(grid.first_from(peer), from)) << n << " " << from;
      for (const std::size_t peer : grid.first_from(from))
        ASSERT_TRUE(has(grid.first_to(peer), from)) << n << " " << from;
      for (std::size_t to = 0; to < n; ++to) {
        const std::size_t between = grid.via(from, to);
        ASSERT_LT(between, n);
        ASSERT_TRUE(has(grid.first_to(from), between)) << n << " " << from << " " << to;
        ASSERT_TRUE(has(grid.second(between), to)) << n << " " << from << " " << to;
        ASSERT_TRUE(has(grid.second(to), between)) << n << " " << from << " " << to;
      }
    }
  }
}

/// Messages of all sizes between all ranks, through agreed phases.
TEST(Hops, BringWhatAnExchangeBrings) {
  for (const int n : {1, 2, 3, 5, 7, 16, 23}) {
    LocalRanks ranks(n);
    ranks.run([&](Communicator& c) {
      const auto me = static_cast<std::size_t>(c.rank());
      const auto size_of = [](std::size_t from, std::size_t to) {
        return (from * 7 + to * 5) % 11;  // 0 too
      };
      ranks::Mail mail(n);
      for (std::size_t r = 0; r < mail.ranks(); ++r)
        mail.to(r).assign(size_of(me, r), std::byte(me + 3 * r));
      exchange_by_hops(c, {}, mail, "make room");
      for (std::size_t r = 0; r < mail.ranks(); ++r) {
        ranks::Reader from = mail.from(r);
        const auto bytes = from.take_all();
        EXPECT_EQ(bytes.size(), size_of(r, me));
        for (const std::byte b : bytes) EXPECT_EQ(b, std::byte(r + 3 * me));
      }
    });
  }
}

/// With many ranks and small messages, two hops are taken and save messages.
TEST(Hops, AreTakenWhereMessagesCost) {
  const Whole whole(PartsScene(8, kParts, false).scene, frame_of(Shader::phong, 96, 96));
  Image<std::int64_t> ids(96, 96);
  const auto messages = [&](int n, WordExchange exchange, WordExchange taken) {
    LocalRanks ranks(n, 1);
    const RanksStats stats =
        whole.draw(ranks, round_robin(n), {.ids = ids}, {.exchange = exchange});
    EXPECT_EQ(stats.exchange, taken);
    std::uint64_t most = 0;
    for (const auto& t : ranks.traffic()) most = std::max(most, t.messages);
    return most;
  };
  (void)messages(4, WordExchange::automatic, WordExchange::sparse);
  const std::uint64_t sparse = messages(64, WordExchange::sparse, WordExchange::sparse);
  EXPECT_LT(messages(64, WordExchange::automatic, WordExchange::two_hops), sparse);
}

}  // namespace
}  // namespace rastrum::test::hops_test
