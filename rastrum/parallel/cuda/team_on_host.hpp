// SPDX-License-Identifier: BSD-3-Clause
// A device's team on the CPU, for tests. Members are coroutines of one thread; each runs until it
// syncs. So a missing sync is wrong in every run: the first member reads what the others have yet
// to write. The order reverses at every sync. ucontext is deterministic and needs no compiler
// support; threads with a barrier took minutes on a busy machine. For the thread sanitizer members
// are threads (team_fibers.hpp), so what they share with their caller is atomic.
#pragma once

#include <ucontext.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/host_walls.hpp>
#include <rastrum/parallel/cuda/team_fibers.hpp>

namespace rastrum::parallel::cuda_system {

/// The stack of a coroutine. Later teams reuse it: fresh memory costs more than the small bodies of
/// tests, above all under a sanitizer.
class TeamStack {
 public:
  static constexpr std::size_t kBytes = std::size_t{1} << 18;
  TeamStack() {
    const Walls::Unseen unseen;
    if (spare().empty()) spare().push_back(std::make_unique_for_overwrite<char[]>(kBytes));
    room_ = std::move(spare().back());
    spare().pop_back();
  }
  ~TeamStack() { spare().push_back(std::move(room_)); }
  TeamStack(const TeamStack&) = delete;
  TeamStack& operator=(const TeamStack&) = delete;
  [[nodiscard]] char* data() { return room_.get(); }

 private:
  static std::vector<std::unique_ptr<char[]>>& spare() {
    thread_local std::vector<std::unique_ptr<char[]>> spare;
    return spare;
  }
  std::unique_ptr<char[]> room_;
};

template <std::size_t kMembers, class Body>
class TeamOnHost {
 public:
  /// Calls body(rank, *this) on all members, which meet in sync(). Throws std::logic_error if one
  /// ends while another waits.
  static void run(const Body& body) { TeamOnHost(body).run_all(); }

  void sync(std::size_t rank) {
    fibers_.arrive(rank);
    fibers_.back();
    swapcontext(&members_[rank].context, &caller_);
    fibers_.depart(rank);
  }

 private:
  struct Member {
    ucontext_t context;
    TeamStack stack;
    std::atomic<bool> done = false;
  };

  explicit TeamOnHost(const Body& body) : body_(&body) {}

  void run_all() {
    TeamOnHost* const outer = current_.load();
    current_ = this;
    for (std::size_t rank = 0; rank < kMembers; ++rank) {
      Member& member = members_[rank];
      getcontext(&member.context);
      member.context.uc_stack.ss_sp = member.stack.data();
      member.context.uc_stack.ss_size = TeamStack::kBytes;
      member.context.uc_link = &caller_;
      makecontext(&member.context, start, 0);
    }
    std::size_t done = 0;
    for (bool forward = true; done == 0; forward = !forward) {
      for (std::size_t k = 0; k < kMembers; ++k) {
        const std::size_t rank = forward ? k : kMembers - 1 - k;
        starting_ = rank;
        fibers_.to(rank);
        swapcontext(&caller_, &members_[rank].context);
      }
      for (const Member& member : members_) done += member.done ? 1U : 0U;
    }
    fibers_.joined();
    current_ = outer;
    if (done != kMembers) throw std::logic_error("a member of a team missed a sync of the others");
  }
  /// Not instrumented, because it returns to the caller's context.
  RASTRUM_NOT_SEEN static void start() {
    TeamOnHost& team = *current_.load();
    team.be_member(team.starting_);
    team.fibers_.back();
  }
  void be_member(std::size_t rank) {
    fibers_.enter();
    (*body_)(rank, *this);
    members_[rank].done = true;
    fibers_.leave();
  }

  static inline thread_local std::atomic<TeamOnHost*> current_ = nullptr;
  const Body* body_;
  std::array<Member, kMembers> members_;
  ucontext_t caller_;
  std::atomic<std::size_t> starting_ = 0;
  TeamFibers<kMembers> fibers_;
};

}  // namespace rastrum::parallel::cuda_system
