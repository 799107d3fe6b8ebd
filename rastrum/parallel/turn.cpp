// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/turn.hpp>

#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

#include <rastrum/core/reject.hpp>

namespace rastrum::parallel {
namespace {

/// Guards the list of turns and their exceptions. Held only briefly.
std::mutex turns_guard;
CallingTurn* newest_turn = nullptr;

}  // namespace

#if defined(__unix__) || defined(__APPLE__)
/// A fork waits for the guard. Its child has the turns of the thread that forked, and no others.
struct CallingTurn::AtFork {
  static const int registered;
};
const int CallingTurn::AtFork::registered =
    pthread_atfork([] { turns_guard.lock(); }, [] { turns_guard.unlock(); },
                   [] {
                     newest_turn = current_guarded();
                     for (CallingTurn* t = newest_turn; t != nullptr; t = t->next_)
                       t->next_ = t->outer_;
                     turns_guard.unlock();
                   });
#endif

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
  while (*at != nullptr && *at != this) at = &(*at)->next_;
  if (*at == this) *at = next_;  // else a fork within an inner scope has left it out
}

CallingTurn* CallingTurn::current() {
  if (StopScope::current() == nullptr) return nullptr;
  const std::lock_guard<std::mutex> lock(turns_guard);
  return current_guarded();
}

// Finds the turn by its token, which is in force in all its work and nowhere else.
CallingTurn* CallingTurn::current_guarded() {
  const StopToken* const token = StopScope::current();
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
