// A team of a device on the CPU, for the tests: its members are coroutines of one thread, each of
// which runs until it syncs. So what is missing a sync is wrong at every run: a member that is
// first reads what the others have yet to write. Who is first changes with every sync. POSIX's
// ucontext: it wants no compiler's help and is deterministic; threads with a barrier took a
// scheduler's turn for each sync, minutes on a busy machine.
#pragma once

#include <ucontext.h>

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

namespace rastrum::parallel::cuda_system {

/// kMembers coroutines that run one body.
template <std::size_t kMembers, class Body>
class TeamOnHost {
 public:
  /// Calls body(rank, *this) by all members, which meet in sync(). Throws std::logic_error where
  /// one ends while another waits.
  static void run(const Body& body) { TeamOnHost(body).run_all(); }

  void sync(std::size_t rank) { swapcontext(&members_[rank].context, &caller_); }

 private:
  static constexpr std::size_t kStackBytes = std::size_t{1} << 18;
  struct Member {
    ucontext_t context;
    std::vector<char> stack = std::vector<char>(kStackBytes);
    bool done = false;
  };

  explicit TeamOnHost(const Body& body) : body_(&body) {}

  void run_all() {
    TeamOnHost* const outer = current_;
    current_ = this;
    for (std::size_t rank = 0; rank < kMembers; ++rank) {
      Member& member = members_[rank];
      getcontext(&member.context);
      member.context.uc_stack.ss_sp = member.stack.data();
      member.context.uc_stack.ss_size = member.stack.size();
      member.context.uc_link = &caller_;
      makecontext(&member.context, start, 0);
    }
    std::size_t done = 0;
    for (bool forward = true; done == 0; forward = !forward) {
      for (std::size_t k = 0; k < kMembers; ++k) {
        starting_ = forward ? k : kMembers - 1 - k;
        swapcontext(&caller_, &members_[starting_].context);
      }
      for (const Member& member : members_) done += member.done ? 1 : 0;
    }
    current_ = outer;
    if (done != kMembers) throw std::logic_error("a member of a team missed a sync of the others");
  }
  static void start() {
    TeamOnHost& team = *current_;
    const std::size_t rank = team.starting_;
    (*team.body_)(rank, team);
    team.members_[rank].done = true;
  }

  static inline thread_local TeamOnHost* current_ = nullptr;
  const Body* body_;
  std::array<Member, kMembers> members_;
  ucontext_t caller_;
  std::size_t starting_ = 0;
};

}  // namespace rastrum::parallel::cuda_system
