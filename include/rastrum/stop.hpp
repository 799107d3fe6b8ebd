// Stopping work that nobody waits for any more, such as the picture of a camera that has moved on.
// Renderer, TerrainRenderer and SceneOnTerrain take a token for each frame; a scope serves what
// calls them deep down.
// A token is in force for the thread that made a StopScope, and for the loops that it begins there,
// nested ones too: the loop is the one place where work is handed out, so that no word and no stage
// needs a parameter for it, and nothing is paid where there is no scope.
//
// Cost: none without a scope but a look at a thread-local pointer a loop and, in bodies that ask by
// themselves, at each question; with one an atomic read a range.
// Source: C++20's std::stop_token; that it is found through the thread, not passed, is as in
// oneTBB's task_group_context.
#pragma once

#include <stop_token>

#include <rastrum/error.hpp>

namespace RASTRUM_API rastrum {

/// Thrown by a call that was stopped.
class Stopped final : public Error {
 public:
  Stopped() : Error(Errc::stopped, "stopped, as asked") {}
};

/// While it lives, the library's loops that this thread begins throw Stopped once `token` is asked
/// to stop: ranges that have begun are finished unless they ask by themselves, the others are left
/// out. Whatever is between two loops runs to its end. Scopes nest; the inner one counts.
class StopScope {
 public:
  /// `token` must outlive the scope; one that nobody can stop leaves the scope around it in force.
  explicit StopScope(const std::stop_token& token) noexcept
      : StopScope(token.stop_possible() ? &token : current()) {}
  /// The same scope on another thread, or none.
  explicit StopScope(const std::stop_token* token) noexcept;
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// The token in force, or null.
  [[nodiscard]] static const std::stop_token* current() noexcept;

 private:
  const std::stop_token* outer_;
};

/// Whether the work of the calling thread is to end. For bodies that take long, between pieces of
/// their work.
[[nodiscard]] inline bool stop_requested() noexcept {
  const std::stop_token* const token = StopScope::current();
  return token != nullptr && token->stop_requested();
}
/// Throws Stopped where it is.
inline void throw_if_stopped() {
  if (stop_requested()) throw Stopped{};
}

}  // namespace rastrum
