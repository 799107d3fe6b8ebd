// How a phase of a frame ends: either on all ranks without an error, or on all with the same one.
// Between a throw and its agreement no collective stands, so nobody waits for who has thrown.
#pragma once

#include <exception>
#include <functional>
#include <string_view>

#include <rastrum/ranks.hpp>

namespace rastrum::ranks {

/// Called at the beginning of each phase's local work; what it throws counts as that work's own
/// error. For tests: none in a frame of users.
using AtPhase = std::function<void(std::string_view phase, int rank)>;

/// `failure`: this rank's, or null. Throws on all ranks what the lowest failing rank has, with
/// "rank R: " before it. Allocates nothing before all ranks know.
void agree(Communicator& ranks, const std::exception_ptr& failure);

/// The local work of a phase, f(), and its agreement.
template <class F>
void in_phase(Communicator& ranks, const AtPhase& at, std::string_view name, const F& f) {
  std::exception_ptr failure;
  ranks.begin_phase(name);
  try {
    if (at) at(name, ranks.rank());
    f();
  } catch (...) {
    failure = std::current_exception();
  }
  agree(ranks, failure);
}

}  // namespace rastrum::ranks
