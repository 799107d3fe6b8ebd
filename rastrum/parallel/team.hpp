// for_each_team: a loop whose bodies are each worked on by a team of threads that share scratch
// memory and wait for each other: a block of threads with shared memory on a device
// (cuda/exec.cuh). On the CPU a team is one thread, and other threads take other bodies: a body
// that is right for teams of any size is right for one.
//
// Work O(n), span O(log n) beside the bodies'. One T per thread on the CPU.
// Source: DESIGN section 5, "one word for work that wants a team with scratch memory".
#pragma once

#include <cstddef>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>

namespace rastrum::parallel {

/// The team of the CPU. Members take the shares rank(), rank() + size(), … of the work, and what
/// one wrote to the scratch the others see after sync(), which all must reach.
class TeamOfOne {
 public:
  [[nodiscard]] static constexpr std::size_t rank() { return 0; }
  [[nodiscard]] static constexpr std::size_t size() { return 1; }
  static constexpr void sync() {}
};

/// Calls f(i, T& scratch, team) for i in [0, n), by each member of a team. `scratch` holds anything
/// at the beginning. kThreads is the size of a device's teams.
template <class T, int kThreads = 128, class Exec, class F>
void for_each_team(Exec& exec, std::size_t n, F&& f) {
  ScratchPool<T> pool;
  for_each_with_scratch(exec, n, pool,
                        [&](std::size_t i, T& scratch) { f(i, scratch, TeamOfOne{}); });
}

}  // namespace rastrum::parallel
