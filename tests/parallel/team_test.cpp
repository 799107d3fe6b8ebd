// SPDX-License-Identifier: BSD-3-Clause
// A device's for_each_team: each member runs every body once, each team has its own scratch, and
// sync works.
#include <numeric>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::team_test {
namespace {

constexpr std::size_t kValues = 64;
struct Shared {
  std::uint32_t value[kValues];
};

// A prefix sum by doubling: each step reads what other members wrote in the last one. So it is
// wrong if a member passes a sync early, or if another team has the same scratch.
struct PrefixSum {
  const std::uint32_t* in;
  std::uint32_t* out;
  template <class Team>
  void operator()(std::size_t i, Shared& shared, const Team& team) const {
    const std::uint32_t* const mine = in + i * kValues;
    for (std::size_t k = team.rank(); k < kValues; k += team.size()) shared.value[k] = mine[k];
    team.sync();
    for (std::size_t step = 1; step < kValues; step *= 2) {
      std::uint32_t sums[kValues];
      for (std::size_t k = team.rank(); k < kValues; k += team.size())
        sums[k] = shared.value[k] + (k >= step ? shared.value[k - step] : 0);
      team.sync();
      for (std::size_t k = team.rank(); k < kValues; k += team.size()) shared.value[k] = sums[k];
      team.sync();
    }
    for (std::size_t k = team.rank(); k < kValues; k += team.size())
      out[i * kValues + k] += shared.value[k];
  }
};

TEST(Team, MembersWorkTogetherOnEachBodyOnce) {
  for (const std::size_t n : {0U, 1U, 2U, 500U}) {
    const auto in = random_values<std::uint32_t>(n * kValues, 1U << 30);
    std::vector<std::uint32_t> expected(in.size());
    for (std::size_t i = 0; i < n; ++i)
      std::partial_sum(in.begin() + static_cast<std::ptrdiff_t>(i * kValues),
                       in.begin() + static_cast<std::ptrdiff_t>((i + 1) * kValues),
                       expected.begin() + static_cast<std::ptrdiff_t>(i * kValues));
    Cuda exec;
    std::vector<std::uint32_t> out(in.size(), 0);
    for_each_team<Shared>(exec, n, PrefixSum{in.data(), out.data()});
    EXPECT_EQ(out, expected);
  }
}

}  // namespace
}  // namespace rastrum::parallel::test::team_test
