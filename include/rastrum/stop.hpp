// SPDX-License-Identifier: BSD-3-Clause
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

#include <concepts>

#include <rastrum/error.hpp>

namespace RASTRUM_API rastrum {

/// Thrown by a call that was stopped.
class Stopped final : public Error {
 public:
  Stopped() : Error(Errc::stopped, "stopped, as asked") {}
};

/// Something that asks to stop: a std::stop_token or std::stop_source, or a class of one's own.
/// stop_requested() is called by several threads at once.
template <class T>
concept AsksToStop = requires(const T& token) {
  { token.stop_requested() } -> std::convertible_to<bool>;
};

/// A view of one, which must outlive it; by default of none. Calls take it as a parameter, so give
/// them the std::stop_token itself, <stop_token> being yours to include.
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
/// to stop: ranges that have begun are finished unless they ask by themselves, the others are left
/// out. Whatever is between two loops runs to its end. Scopes nest; the inner one counts.
class StopScope {
 public:
  /// `token` must outlive the scope; one that nobody can stop leaves the scope around it in force.
  template <AsksToStop T>
  explicit StopScope(const T& token) noexcept
      : token_(token), outer_(enter(token_.stop_possible() ? &token_ : current())) {}
  template <AsksToStop T>
  StopScope(const T&&) = delete;  // this token ends before the scope does: give it a name first
  /// The same scope on another thread, or none.
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

/// Whether the work of the calling thread is to end. For bodies that take long, between pieces of
/// their work.
[[nodiscard]] inline bool stop_requested() noexcept {
  const StopToken* const token = StopScope::current();
  return token != nullptr && token->stop_requested();
}
/// Throws Stopped where it is.
inline void throw_if_stopped() {
  if (stop_requested()) throw Stopped{};
}

}  // namespace rastrum
