// A missing sync of a team is a race that the thread sanitizer reports, whoever came first: bodies
// that are right, and the same with one sync left out, each in a process of its own. Here the
// results are right all the same, so that no other test would see it.
#include <cstdlib>
#include <vector>

#include <rastrum/parallel/cuda/team.cuh>

#include <tests/parallel/backends.hpp>

namespace rastrum::parallel::test::team_races_test {
namespace {

constexpr std::size_t kValues = 12;
struct Shared {
  std::uint32_t value[kValues];
};

/// Every element of `out` is the sum of all values; whoever is first has written them all.
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

/// Exits with 0 where the sums are right; the thread sanitizer makes that 66 where it saw a race.
[[noreturn]] void sums(bool syncs_before, bool syncs_after) {
  std::vector<std::uint32_t> out(3, 0);
  {
    Cuda exec;
    for_each_team<Shared>(exec, out.size(), Sum{out.data(), syncs_before, syncs_after});
    exec.wait();
  }
  std::exit(out == std::vector<std::uint32_t>{66, 78, 90} ? 0 : 1);
}

class TeamRaces : public testing::Test {
 protected:
  void SetUp() override {
    if (!cuda_system::kRacesAreSeen) GTEST_SKIP() << "built without the thread sanitizer";
    // A process of its own from the start, since this one may have had threads.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
  }
};

TEST_F(TeamRaces, NoneWhereMembersSync) {
  EXPECT_EXIT(sums(true, true), testing::ExitedWithCode(0), "");
}
TEST_F(TeamRaces, AMissingSyncBeforeAReadIsReported) {
  EXPECT_EXIT(sums(false, true), testing::ExitedWithCode(66), "ThreadSanitizer: data race");
}
TEST_F(TeamRaces, AMissingSyncBeforeAWriteIsReported) {
  EXPECT_EXIT(sums(true, false), testing::ExitedWithCode(66), "ThreadSanitizer: data race");
}
/// A member that adds to a word of another's outside of an atomic.
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
TEST_F(TeamRaces, AtomicsAreNone) {
  EXPECT_EXIT(marks(true), testing::ExitedWithCode(0), "");
}
TEST_F(TeamRaces, WordsThatSeveralChangeAreReported) {
  EXPECT_EXIT(marks(false), testing::ExitedWithCode(66), "ThreadSanitizer: data race");
}

/// Elements of a loop that each add to the same word.
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
TEST_F(TeamRaces, ElementsOfALoopMayShareAtomics) {
  EXPECT_EXIT(count(true, false), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(count(true, true), testing::ExitedWithCode(0), "");
}
TEST_F(TeamRaces, ElementsOfALoopThatShareAWordAreReported) {
  EXPECT_EXIT(count(false, false), testing::ExitedWithCode(66), "ThreadSanitizer: data race");
  EXPECT_EXIT(count(false, true), testing::ExitedWithCode(66), "ThreadSanitizer: data race");
}

}  // namespace
}  // namespace rastrum::parallel::test::team_races_test
