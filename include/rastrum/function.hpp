// SPDX-License-Identifier: BSD-3-Clause
// FunctionRef, a function that a call takes and does not keep, and Function, one that is kept.
// <functional>, which has the second, takes longer to compile than most of what includes this.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include <rastrum/config.hpp>
#include <rastrum/held.hpp>

namespace RASTRUM_API rastrum {

template <class Signature>
class FunctionRef;
template <class Signature>
class Function;

/// Refers to anything that can be called as R(Args…): a function, a lambda, a std::function. This
/// must live longer, so take a FunctionRef as a parameter and do not keep it. Null by default.
template <class R, class... Args>
class FunctionRef<R(Args...)> {
 public:
  FunctionRef() = default;
  FunctionRef(std::nullptr_t) {}
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
           !std::is_member_pointer_v<std::remove_cvref_t<F>> &&
           std::is_invocable_r_v<R, F&, Args...>) FunctionRef(F&& f)
      : call_(&call<std::remove_reference_t<F>>) {
    if constexpr (std::is_function_v<std::remove_reference_t<F>>)
      function_ = reinterpret_cast<void (*)()>(&f);
    else
      object_ = &f;
    // An empty std::function is none, and neither is a null pointer one.
    if constexpr (requires { f.operator bool(); } || std::is_pointer_v<std::remove_cvref_t<F>>)
      if (!f) call_ = nullptr;
  }

  [[nodiscard]] explicit operator bool() const { return call_ != nullptr; }
  /// Throws Error{invalid_argument} where there is no function.
  R operator()(Args... args) const {
    if (call_ == nullptr) held_detail::throw_no_function();
    return call_(*this, std::forward<Args>(args)...);
  }

 private:
  template <class F>
  static R call(const FunctionRef& self, Args... args) {
    if constexpr (std::is_function_v<F>)
      return static_cast<R>(reinterpret_cast<F*>(self.function_)(std::forward<Args>(args)...));
    else
      return static_cast<R>(
          (*static_cast<F*>(const_cast<void*>(self.object_)))(std::forward<Args>(args)...));
  }

  R (*call_)(const FunctionRef&, Args...) = nullptr;
  union {
    const void* object_ = nullptr;
    void (*function_)();
  };
};

/// Holds a copy of anything that can be called as R(Args…). Copies of a Function share it, and a
/// move is a copy.
template <class R, class... Args>
class Function<R(Args...)> {
 public:
  Function() = default;
  Function(std::nullptr_t) {}
  Function(const Function&) = default;
  Function& operator=(const Function&) = default;
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, Function> &&
           !std::is_member_pointer_v<std::decay_t<F>> &&
           std::is_invocable_r_v<R, std::decay_t<F>&, Args...>) Function(F&& f)
      : Function(new Copy<std::decay_t<F>>(std::forward<F>(f))) {}

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(call_); }
  R operator()(Args... args) const { return call_(std::forward<Args>(args)...); }
  /// The function that it calls, if that is an F; else null.
  template <class F>
  [[nodiscard]] const F* target() const {
    const auto* const copy = dynamic_cast<const Copy<F>*>(kept_.get());
    return copy != nullptr ? &copy->f : nullptr;
  }

 private:
  struct Kept {
    virtual ~Kept() = default;
  };
  template <class F>
  struct RASTRUM_INSIDE Copy final : Kept {
    template <class From>
    explicit Copy(From&& from) : f(std::forward<From>(from)) {}
    F f;
  };
  template <class F>
  explicit Function(Copy<F>* made) : kept_(Owner<Kept>(made)), call_(made->f) {}

  Shared<Kept> kept_;
  FunctionRef<R(Args...)> call_;
};

}  // namespace rastrum
