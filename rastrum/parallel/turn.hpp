// SPDX-License-Identifier: BSD-3-Clause
// Turns at objects such as renderers: several threads may call them, but they work for one caller
// at a time, because their threads and scratch serve one frame.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::parallel {

/// A turn whose work calls the caller's functions from code that must not throw. Their first
/// exception stops the work.
class CallingTurn {
 public:
  /// Throws as in_turn.
  CallingTurn(std::mutex& one_at_a_time, StopToken stop);
  ~CallingTurn();
  CallingTurn(const CallingTurn&) = delete;
  CallingTurn& operator=(const CallingTurn&) = delete;

  /// Returns work(); throws the first exception of a function given to call().
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
  /// Calls a caller's function, on any thread of the turn's work. Returns false if it throws.
  /// Outside of a turn an exception ends the process.
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

  /// Returns `turn`; throws if the calling thread already works for it.
  static std::mutex& not_within(std::mutex& turn);

 private:
  /// Requests a stop if a function has thrown or if `asked` does.
  struct Stop {
    StopToken asked;
    std::atomic<bool> thrown = false;
    [[nodiscard]] bool stop_requested() const noexcept { return thrown || asked.stop_requested(); }
  };

  /// The turn that the calling thread works for, or null.
  static CallingTurn* current();
  static CallingTurn* current_guarded();
  struct AtFork;
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

/// Waits for a turn, then returns work() with `stop` in force and the library's floating-point mode
/// set. Throws Stopped if a stop is already requested, and Error{out_of_memory} as in_memory does.
/// Throws Error{invalid_argument} if a CallingTurn of the same object calls the caller, which would
/// wait for itself.
template <class Work>
auto in_turn(std::mutex& one_at_a_time, StopToken stop, const Work& work) {
  const std::lock_guard<std::mutex> lock(CallingTurn::not_within(one_at_a_time));
  const StopScope scope(stop);
  const FloatScope floats;
  throw_if_stopped();
  return in_memory(work);
}

}  // namespace rastrum::parallel
