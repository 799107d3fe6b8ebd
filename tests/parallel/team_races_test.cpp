// SPDX-License-Identifier: BSD-3-Clause
// The thread sanitizer reports a team's missing sync as a race, whatever the timing. Tests correct
// bodies, and the same with one sync removed, each in a process of its own. Here the results are
// correct anyway, so no other test would notice.
#include <cstdlib>
#include <string>
#include <vector>

#include <rastrum/parallel/cuda/team.cuh>

#include "tests/parallel/backends.hpp"

namespace rastrum::parallel::test::team_races_test {
namespace {

constexpr std::size_t kValues = 12;
struct Shared {
  std::uint32_t value[kValues];
};

/// Each element of `out` is the sum of all values; the first member writes them all.
struct Sum {
  std::uint32_t* out;
  bool syncs_before, syncs_after;
  template <class Team>
  void operator()(std::size_t i, Shared& shared, const Team& team) const {
    if (team.rank() == 0)
      for (std::size_t k = 0; k < kValues; ++k) shared.value[k] = static_cast<std::uint32_t>(i + k);
    if (syncs_before) team.sync();
    std::uint32_t sum = 0;
    for (const std::uint32_t value : shared.value) sum += value;
    if (team.rank() == team.size() - 1) out[i] = sum;
    if (syncs_after) team.sync();
    if (team.rank() == 0) shared.value[0] = 1;
  }
};

/// Exits with 0 if the sums are right; the thread sanitizer exits with 66 after a race.
[[noreturn]] void sums(bool syncs_before, bool syncs_after) {
  std::vector<std::uint32_t> out(3, 0);
  {
    Cuda exec;
    for_each_team<Shared>(exec, out.size(), Sum{out.data(), syncs_before, syncs_after});
    exec.wait();
  }
  std::exit(out == std::vector<std::uint32_t>{66, 78, 90} ? 0 : 1);
}

/// A member that adds to another's word without an atomic.
struct Marks {
  std::uint32_t* out;
  bool is_atomic;
  template <class Team>
  void operator()(std::size_t, Shared& shared, const Team& team) const {
    if (team.rank() == 0) shared.value[0] = 0;
    team.sync();
    const std::uint32_t bit = 1U << team.rank();
    if (is_atomic)
      atomic_or(shared.value[0], bit);
    else
      shared.value[0] |= bit;
    team.sync();
    if (team.rank() == 0) *out = shared.value[0];
  }
};
[[noreturn]] void marks(bool is_atomic) {
  std::uint32_t out = 0;
  {
    Cuda exec;
    for_each_team<Shared>(exec, 1, Marks{&out, is_atomic});
    exec.wait();
  }
  std::exit(out == (1U << cuda_system::kTeamMembers<128>)-1U ? 0 : 1);
}
/// A loop whose elements all add to the same word.
struct Count {
  std::uint32_t* sum;
  bool is_atomic;
  void operator()(std::size_t) const {
    if (is_atomic)
      atomic_or(*sum, 1U);
    else
      *sum = 1;
  }
  void operator()(std::size_t i, int&) const { (*this)(i); }
  void end(int) const {}
};
[[noreturn]] void count(bool is_atomic, bool is_strided) {
  std::uint32_t sum = 0;
  {
    Cuda exec;
    if (is_strided)
      for_each_strided<int>(exec, 10, Count{&sum, is_atomic});
    else
      for_each_index(exec, 10, Count{&sum, is_atomic});
    exec.wait();
  }
  std::exit(sum == 1 ? 0 : 1);
}
struct Case {
  const char* name;
  void (*run)();
  bool is_race;
};
class TeamRaces : public testing::TestWithParam<Case> {};

TEST_P(TeamRaces, AreReported) {
  if (!cuda_system::kRacesAreSeen) GTEST_SKIP() << "built without the thread sanitizer";
  // A new process, since this one may already have threads.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(GetParam().run(), testing::ExitedWithCode(GetParam().is_race ? 66 : 0),
              GetParam().is_race ? "ThreadSanitizer: data race" : "");
}
INSTANTIATE_TEST_SUITE_P(
    Bodies, TeamRaces,
    testing::Values(Case{"synced", [] { sums(true, true); }, false},
                    Case{"no_sync_before_a_read", [] { sums(false, true); }, true},
                    Case{"no_sync_before_a_write", [] { sums(true, false); }, true},
                    Case{"atomic_marks", [] { marks(true); }, false},
                    Case{"marks_of_several", [] { marks(false); }, true},
                    Case{"atomics_of_a_loop", [] { count(true, false); }, false},
                    Case{"atomics_of_a_strided_loop", [] { count(true, true); }, false},
                    Case{"word_of_a_loop", [] { count(false, false); }, true},
                    Case{"word_of_a_strided_loop", [] { count(false, true); }, true}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace rastrum::parallel::test::team_races_test
