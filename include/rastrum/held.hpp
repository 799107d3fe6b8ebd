// A pointer to the hidden members of a class, which moves with the object.
#pragma once

#include <utility>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

namespace held_detail {
/// Throws Error{invalid_argument}.
[[noreturn]] void throw_moved_from(const char* name);
}  // namespace held_detail

/// A pointer that is null only in an object that was moved from; using it there throws
/// Error{invalid_argument}. `Pointer`: plain or a std::unique_ptr.
template <class Pointer>
class Held {
 public:
  /// `name`: the class that holds it.
  Held(const char* name, Pointer pointer) : name_(name), pointer_(std::move(pointer)) {}
  Held(const Held&) = default;
  Held& operator=(const Held&) = default;
  Held(Held&& other) noexcept
      : name_(other.name_), pointer_(std::exchange(other.pointer_, nullptr)) {}
  Held& operator=(Held&& other) noexcept {
    pointer_ = std::exchange(other.pointer_, nullptr);
    return *this;
  }
  ~Held() = default;

  [[nodiscard]] auto& operator*() const {
    if (pointer_ == nullptr) held_detail::throw_moved_from(name_);
    return *pointer_;
  }
  [[nodiscard]] auto* operator->() const { return &**this; }

 private:
  const char* name_;
  Pointer pointer_;
};

}  // namespace rastrum
