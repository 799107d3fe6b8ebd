// SPDX-License-Identifier: BSD-3-Clause
// Stops work that nobody waits for any more, such as the picture of a camera that has moved on.
// Renderer, TerrainRenderer and SceneOnTerrain take a token for each frame; a scope serves what
// calls them deep down. A token is in force for the thread that made a StopScope and for the loops
// that it begins there, nested ones too. The loop is the one place where work is handed out, so no
// word and no stage needs a parameter for it.
//
// Cost: without a scope a look at a thread-local pointer for each loop and, in bodies that ask by
// themselves, for each question; with one an atomic read for each range.
// Source: C++20's std::stop_token. It is found through the thread, not passed, as in oneTBB's
// task_group_context.
#pragma once

#include <concepts>

#include <rastrum/error.hpp>

namespace RASTRUM_API rastrum {

/// Thrown by a call that was stopped.
class Stopped final : public Error {
 public:
  Stopped() : Error(Errc::stopped, "stopped, as asked") {}
};

/// A type that can ask to stop: std::stop_token, std::stop_source or a class of one's own. Several
/// threads call stop_requested() at once; it must not throw.
template <class T>
concept AsksToStop = requires(const T& token) {
  { token.stop_requested() } -> std::convertible_to<bool>;
};

/// A view of something that asks to stop, which must outlive it; by default a view of nothing. Give
/// calls the std::stop_token itself, and include <stop_token> yourself.
class StopToken {
 public:
  StopToken() = default;
  template <AsksToStop T>
  requires(!std::same_as<T, StopToken>) StopToken(const T& token)
  noexcept : token_(&token) {
    if constexpr (requires { token.stop_possible(); })
      if (!token.stop_possible()) return;
    asked_ = [](const void* t) -> bool { return static_cast<const T*>(t)->stop_requested(); };
  }

  [[nodiscard]] bool stop_possible() const noexcept { return asked_ != nullptr; }
  [[nodiscard]] bool stop_requested() const noexcept { return asked_ != nullptr && asked_(token_); }

 private:
  const void* token_ = nullptr;
  bool (*asked_)(const void* token) = nullptr;
};

/// While it lives, the library's loops that this thread begins throw Stopped once `token` is asked
/// to stop. Ranges that have begun are finished unless they ask by themselves; the others are left
/// out. Whatever is between two loops runs to its end. Scopes nest; the inner one counts.
class StopScope {
 public:
  /// `token` must outlive the scope. If it cannot be stopped, the outer scope stays in force.
  template <AsksToStop T>
  explicit StopScope(const T& token) noexcept
      : token_(token), outer_(enter(token_.stop_possible() ? &token_ : current())) {}
  template <AsksToStop T>
  StopScope(const T&&) = delete;  // this token ends before the scope does: give it a name first
  /// Puts the token of a scope (current()) in force on another thread; null: none.
  explicit StopScope(const StopToken* token) noexcept : outer_(enter(token)) {}
  ~StopScope() { enter(outer_); }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// The token in force, or null.
  [[nodiscard]] static const StopToken* current() noexcept;

 private:
  /// Puts a token in force; returns the one before.
  static const StopToken* enter(const StopToken* token) noexcept;

  StopToken token_;
  const StopToken* outer_;
};

/// Whether the calling thread's work is to end. Bodies that take long ask between pieces of it.
[[nodiscard]] inline bool stop_requested() noexcept {
  const StopToken* const token = StopScope::current();
  return token != nullptr && token->stop_requested();
}
/// Throws Stopped if stop_requested().
inline void throw_if_stopped() {
  if (stop_requested()) throw Stopped{};
}

}  // namespace rastrum
