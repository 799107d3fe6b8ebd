// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/turn.hpp>

#include <utility>

#include <rastrum/core/reject.hpp>

namespace rastrum::parallel {
namespace {

/// Guards the list of turns and their exceptions. Held only briefly.
std::mutex turns_guard;
CallingTurn* newest_turn = nullptr;

}  // namespace

CallingTurn::CallingTurn(std::mutex& one_at_a_time, StopToken stop)
    : lock_(not_within(one_at_a_time)), mutex_(one_at_a_time), outer_(current()) {
  // Without a `stop` the surrounding scope's token applies.
  if (stop.stop_possible())
    stop_.asked = stop;
  else if (before_ != nullptr)
    stop_.asked = *before_;
  if (stop_.stop_requested()) throw Stopped{};
  const std::lock_guard<std::mutex> lock(turns_guard);
  next_ = std::exchange(newest_turn, this);
}

CallingTurn::~CallingTurn() {
  const std::lock_guard<std::mutex> lock(turns_guard);
  CallingTurn** at = &newest_turn;
  while (*at != this) at = &(*at)->next_;
  *at = next_;
}

// Finds the turn by its token, which is in force in all its work and nowhere else.
CallingTurn* CallingTurn::current() {
  const StopToken* const token = StopScope::current();
  if (token == nullptr) return nullptr;
  const std::lock_guard<std::mutex> lock(turns_guard);
  CallingTurn* turn = newest_turn;
  while (turn != nullptr && &turn->token_ != token) turn = turn->next_;
  return turn;
}

std::mutex& CallingTurn::not_within(std::mutex& turn) {
  for (const CallingTurn* t = current(); t != nullptr; t = t->outer_)
    if (&t->mutex_ == &turn)
      reject(
          "a function that a frame calls (for vertices, as a shader, as a fragment test) called "
          "the renderer of that frame, which would wait for itself; give the function its own "
          "renderer");
  return turn;
}

void CallingTurn::keep(std::exception_ptr thrown) {
  CallingTurn* const turn = current();
  if (turn == nullptr) std::rethrow_exception(thrown);
  {
    const std::lock_guard<std::mutex> lock(turns_guard);
    if (turn->first_ == nullptr) turn->first_ = std::move(thrown);
  }
  turn->stop_.thrown = true;
}

void CallingTurn::rethrow() const {
  if (first_ != nullptr) std::rethrow_exception(first_);
}

}  // namespace rastrum::parallel
