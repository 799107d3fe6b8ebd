// SPDX-License-Identifier: BSD-3-Clause
// Tells the thread sanitizer that members of a team on the CPU (team_on_host.hpp) are fibers that
// only syncs order. So it reports any two accesses without a sync between, whichever member came
// first, where the coroutines' order would show a missing sync only by luck. Without that sanitizer
// this does nothing.
#pragma once

#include <array>
#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define RASTRUM_TEAM_FIBERS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RASTRUM_TEAM_FIBERS 1
#endif
#endif

#if defined(RASTRUM_TEAM_FIBERS)
#include <sanitizer/tsan_interface.h>

#include <vector>
// GCC only: clang instruments the function's entry even so.
#define RASTRUM_NOT_SEEN __attribute__((no_sanitize_thread, noinline))
#else
#define RASTRUM_NOT_SEEN
#endif

namespace rastrum::parallel::cuda_system {

#if defined(RASTRUM_TEAM_FIBERS)

inline constexpr bool kRacesAreSeen = true;

template <std::size_t kMembers>
class TeamFibers {
 public:
  TeamFibers() : caller_(__tsan_get_current_fiber()) {
    for (Member& member : members_) member.fiber = take();
    __tsan_release(&begun_);
  }
  ~TeamFibers() {
    for (const Member& member : members_) spare().fibers.push_back(member.fiber);
  }
  TeamFibers(const TeamFibers&) = delete;
  TeamFibers& operator=(const TeamFibers&) = delete;

  /// Called just before a switch to a member's context, and back. They do not synchronize. Not
  /// instrumented, because they are entered in one fiber and left in another.
  RASTRUM_NOT_SEEN void to(std::size_t rank) {
    __tsan_switch_to_fiber(members_[rank].fiber, kOrdersNothing);
  }
  RASTRUM_NOT_SEEN void back() { __tsan_switch_to_fiber(caller_, kOrdersNothing); }
  /// A member's `enter` comes after all that the caller did before; `leave` comes before all that
  /// the caller does after `joined`.
  void enter() { __tsan_acquire(&begun_); }
  void leave() { __tsan_release(&ended_); }
  void joined() { __tsan_acquire(&ended_); }
  /// A member calls them around its wait. No member is two meetings ahead, so two places suffice.
  void arrive(std::size_t rank) { __tsan_release(&met_[members_[rank].meetings & 1U]); }
  void depart(std::size_t rank) { __tsan_acquire(&met_[members_[rank].meetings++ & 1U]); }

 private:
  static constexpr unsigned kOrdersNothing = 1;  // __tsan_switch_to_fiber_no_sync
  struct Member {
    void* fiber = nullptr;
    unsigned meetings = 0;
  };
  /// Reused by later teams, because a fiber costs as much as a thread.
  struct Spare {
    std::vector<void*> fibers;
    ~Spare() {
      for (void* const fiber : fibers) __tsan_destroy_fiber(fiber);
    }
  };
  static Spare& spare() {
    thread_local Spare spare;
    return spare;
  }
  static void* take() {
    std::vector<void*>& fibers = spare().fibers;
    if (fibers.empty()) return __tsan_create_fiber(0);
    void* const fiber = fibers.back();
    fibers.pop_back();
    return fiber;
  }

  void* caller_;
  std::array<Member, kMembers> members_;
  char begun_ = 0, ended_ = 0;
  std::array<char, 2> met_{};
};

#else

inline constexpr bool kRacesAreSeen = false;

template <std::size_t kMembers>
struct TeamFibers {
  void to(std::size_t) {}
  void back() {}
  void enter() {}
  void leave() {}
  void joined() {}
  void arrive(std::size_t) {}
  void depart(std::size_t) {}
};

#endif

}  // namespace rastrum::parallel::cuda_system
