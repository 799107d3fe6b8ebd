// SPDX-License-Identifier: BSD-3-Clause
// How a phase of a frame ends: either on all ranks without an error, or on all with the same one.
// Between a throw and its agreement no collective stands, so nobody waits for who has thrown.
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

/// Called at the beginning of each phase's local work; what it throws counts as that work's own
/// error. For tests: none in a frame of users.
using AtPhase = std::function<void(std::string_view phase, int rank)>;

/// Numbers that ranks agree on together with how a phase ended: the greatest of each.
inline constexpr std::size_t kMostNumbers = 7;

/// `failure`: this rank's, or null. Throws on all ranks what the lowest failing rank has, with
/// "rank R: " before it; else `numbers`, of which there are kMostNumbers at most, are the greatest
/// of all ranks. Allocates nothing before all ranks know.
void agree(Communicator& ranks, const std::exception_ptr& failure,
           std::span<std::uint64_t> numbers = {});

/// A phase's local work, f(), whose agreement comes later: with the next phase's, before which
/// there is no collective. Nothing is done where `failure` is there already.
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

/// The local work of a phase, f(), and its agreement.
template <class F>
void in_phase(Communicator& ranks, const AtPhase& at, std::string_view name, const F& f) {
  std::exception_ptr failure;
  locally(ranks, at, name, f, failure);
  agree(ranks, failure);
}

}  // namespace rastrum::ranks
