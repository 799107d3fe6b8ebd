// SPDX-License-Identifier: BSD-3-Clause
// Objects that work for one caller at a time, but may be called by several threads at once: the
// renderers, whose threads and scratch are for one frame.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::parallel {

/// A turn whose work calls functions of the caller's from code that must not throw. The first
/// exception stops the work.
class CallingTurn {
 public:
  /// Throws as in_turn.
  CallingTurn(std::mutex& one_at_a_time, StopToken stop);
  ~CallingTurn();
  CallingTurn(const CallingTurn&) = delete;
  CallingTurn& operator=(const CallingTurn&) = delete;

  /// Returns work(); throws the first exception of a function that it gave to call().
  template <class Work>
  auto run(const Work& work) {
    try {
      auto result = in_memory(work);
      rethrow();
      return result;
    } catch (const Stopped&) {
      rethrow();
      throw;
    }
  }
  /// Calls a function of the caller's; any thread of the turn's work may do so. Returns false if it
  /// throws. Ends the process if it throws outside of a turn.
  template <class Function>
  static bool call(const Function& function) noexcept {
    try {
      function();
      return true;
    } catch (...) {
      keep(std::current_exception());
      return false;
    }
  }

  /// Returns `turn`; throws if the calling thread works for it already.
  static std::mutex& not_within(std::mutex& turn);

 private:
  /// Asks to stop where a function has thrown, and where `asked` does.
  struct Stop {
    StopToken asked;
    std::atomic<bool> thrown = false;
    [[nodiscard]] bool stop_requested() const noexcept { return thrown || asked.stop_requested(); }
  };

  /// The turn that the calling thread works for, or null.
  static CallingTurn* current();
  static void keep(std::exception_ptr thrown);
  void rethrow() const;

  std::lock_guard<std::mutex> lock_;
  std::mutex& mutex_;
  CallingTurn* const outer_;  ///< the turn that the caller works for
  const StopToken* const before_ = StopScope::current();
  CallingTurn* next_ = nullptr;
  std::exception_ptr first_;
  Stop stop_;
  const StopToken token_{stop_};
  StopScope scope_{&token_};
  FloatScope floats_;
};

/// Returns work() in the calling thread's turn, for which it waits, with `stop` in force and the
/// library's floating-point mode set. Throws Stopped if a stop has been requested by then,
/// Error{out_of_memory} as in_memory, and Error{invalid_argument} if the caller is a function that
/// a CallingTurn of the same object calls, because it would wait for itself.
template <class Work>
auto in_turn(std::mutex& one_at_a_time, StopToken stop, const Work& work) {
  const std::lock_guard<std::mutex> lock(CallingTurn::not_within(one_at_a_time));
  const StopScope scope(stop);
  const FloatScope floats;
  throw_if_stopped();
  return in_memory(work);
}

}  // namespace rastrum::parallel
