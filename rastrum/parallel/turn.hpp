// Objects that work for one caller at a time, but may be called by several threads at once: the
// renderers, whose threads and scratch are for one frame.
#pragma once

#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::parallel {

/// While it lives, the calling thread has its turn, its work heeds `stop`, and it computes as the
/// library does.
class Turn {
 public:
  /// Waits for the turn. Both must outlive it. Throws Stopped where `stop` has been asked by then,
  /// and Error{invalid_argument} where the caller is a function that a CallingTurn of the same
  /// object calls, which would wait for itself.
  explicit Turn(std::mutex& one_at_a_time, const std::stop_token& stop = {});

 private:
  std::lock_guard<std::mutex> lock_;
  StopScope scope_;
  FloatScope floats_;
};

/// A turn whose work calls functions of the caller's, which may throw though what calls them may
/// not: the first exception stops the work.
class CallingTurn {
 public:
  /// As Turn's.
  CallingTurn(std::mutex& one_at_a_time, const std::stop_token& stop);
  ~CallingTurn();
  CallingTurn(const CallingTurn&) = delete;
  CallingTurn& operator=(const CallingTurn&) = delete;

  /// work(); throws what a function threw through call() meanwhile.
  template <class Work>
  auto run(const Work& work) {
    try {
      auto result = work();
      rethrow();
      return result;
    } catch (const Stopped&) {
      rethrow();
      throw;
    }
  }
  /// function(), of the caller's, by any thread that is at the turn's work; returns whether it
  /// threw nothing. Ends the process where it throws and there is no such turn.
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

 private:
  friend class Turn;
  struct Stop {
    std::stop_source& source;
    void operator()() const { source.request_stop(); }
  };

  /// The turn whose work the calling thread is at, or null.
  static CallingTurn* current();
  /// `turn`, unless the calling thread is at its work.
  static std::mutex& not_within(std::mutex& turn);
  static void keep(std::exception_ptr thrown);
  void rethrow() const;

  std::lock_guard<std::mutex> lock_;
  std::mutex& mutex_;
  CallingTurn* const outer_;  ///< whose work the caller is at
  const std::stop_token* const before_ = StopScope::current();
  CallingTurn* next_ = nullptr;
  std::exception_ptr first_;
  std::stop_source source_;
  const std::stop_token token_ = source_.get_token();
  std::optional<std::stop_callback<Stop>> asked_;
  StopScope scope_{token_};
  FloatScope floats_;
};

}  // namespace rastrum::parallel
