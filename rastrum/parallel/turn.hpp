// Objects that work for one caller at a time, but may be called by several threads at once: the
// renderers, whose threads and scratch are for one frame.
#pragma once

#include <mutex>
#include <stop_token>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::parallel {

/// While it lives, the calling thread has its turn, its work heeds `stop`, and it computes as the
/// library does.
class Turn {
 public:
  /// Waits for the turn. Both must outlive it. Throws Stopped where `stop` has been asked by then.
  explicit Turn(std::mutex& one_at_a_time, const std::stop_token& stop = {})
      : lock_(one_at_a_time), scope_(stop) {
    throw_if_stopped();
  }

 private:
  std::lock_guard<std::mutex> lock_;
  StopScope scope_;
  FloatScope floats_;
};

}  // namespace rastrum::parallel
