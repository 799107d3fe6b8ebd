// SPDX-License-Identifier: BSD-3-Clause
// A phase of a frame ends on all ranks without an error, or on all with the same one. There is no
// collective call between a throw and its agreement, so nobody waits for the rank that has thrown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <string_view>

#include <rastrum/ranks.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::ranks {

/// For tests: called at the beginning of each phase's local work. An exception of it counts as that
/// work's own.
using AtPhase = std::function<void(std::string_view phase, int rank)>;

/// The most numbers that ranks agree on together with a phase's end.
inline constexpr std::size_t kMostNumbers = 7;

/// `failure`: this rank's, or null. If any rank failed, all throw the failure of the lowest such
/// rank, after "rank R: ". Otherwise each of `numbers` (at most kMostNumbers) becomes the greatest
/// of all ranks. Allocates nothing before all ranks know.
void agree(Communicator& ranks, const std::exception_ptr& failure,
           std::span<std::uint64_t> numbers = {});

/// Runs f(), a phase's local work; the next phase agrees on its failure. There is no collective
/// call in between. Does nothing if `failure` is already set.
template <class F>
void locally(Communicator& ranks, const AtPhase& at, std::string_view name, const F& f,
             std::exception_ptr& failure) {
  if (failure) return;
  ranks.begin_phase(name);
  try {
    throw_if_stopped();
    if (at) at(name, ranks.rank());
    f();
  } catch (...) {
    failure = std::current_exception();
  }
}

/// Runs f(), a phase's local work, and agrees on its failure.
template <class F>
void in_phase(Communicator& ranks, const AtPhase& at, std::string_view name, const F& f) {
  std::exception_ptr failure;
  locally(ranks, at, name, f, failure);
  agree(ranks, failure);
}

}  // namespace rastrum::ranks
