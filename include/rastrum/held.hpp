// SPDX-License-Identifier: BSD-3-Clause
// Pointers to the hidden members of a class. They do what std::unique_ptr and std::shared_ptr do;
// <memory>, which has those, takes longer to compile than most of what includes this.
#pragma once

#include <concepts>
#include <cstddef>
#include <utility>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

namespace held_detail {
/// Throws Error{invalid_argument}.
[[noreturn]] void throw_moved_from(const char* name);

/// Counts who shares an object; the last to leave destroys it.
struct RASTRUM_INSIDE Count;
[[nodiscard]] Count* first_of(void (*destroy)(const void* object), const void* object);
void join(Count* count) noexcept;
void leave(Count* count) noexcept;

/// Throws Error{invalid_argument}.
[[noreturn]] void throw_no_function();

/// Whether a P points to an object, as std::unique_ptr and std::shared_ptr do.
template <class P, class T>
concept PointsTo = requires(P& owner) {
  { owner.get() } -> std::convertible_to<T*>;
};
}  // namespace held_detail

/// Owns an object, which `delete` ends, or null. `T` must be complete where this is destroyed.
template <class T>
class Owner {
 public:
  Owner() = default;
  Owner(std::nullptr_t) {}
  explicit Owner(T* object) : object_(object) {}
  template <held_detail::PointsTo<T> P>
  requires requires(P& owner) { owner.release(); }
  Owner(P owner) : object_(owner.release()) {}
  Owner(Owner&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Owner& operator=(Owner&& other) noexcept {
    Owner taken(std::move(other));
    std::swap(object_, taken.object_);
    return *this;
  }
  ~Owner() { destroy(); }

  [[nodiscard]] T* get() const { return object_; }
  [[nodiscard]] T* release() { return std::exchange(object_, nullptr); }
  [[nodiscard]] T& operator*() const { return *object_; }
  [[nodiscard]] T* operator->() const { return object_; }
  [[nodiscard]] bool operator==(std::nullptr_t) const { return object_ == nullptr; }

 private:
  void destroy() {
    static_assert(sizeof(T) > 0, "declare the destructor where the object's type is complete");
    delete release();
  }

  T* object_ = nullptr;
};

/// An object that its copies share, or null; made of a std::unique_ptr or a std::shared_ptr. Any
/// number of threads may copy it.
template <class T>
class Shared {
 public:
  Shared() = default;
  /// Keeps `pointer`, which ends the object in its own way.
  template <held_detail::PointsTo<T> P>
  Shared(P pointer) {
    if (pointer.get() == nullptr) return;
    Owner<const P> kept(new P(std::move(pointer)));
    count_ = held_detail::first_of([](const void* object) { delete static_cast<const P*>(object); },
                                   kept.get());
    object_ = kept.release()->get();
  }
  Shared(const Shared& other) noexcept : count_(other.count_), object_(other.object_) {
    if (count_ != nullptr) held_detail::join(count_);
  }
  /// Shares an object of a class that is derived from T.
  template <class Derived>
  requires std::convertible_to<Derived*, T*> Shared(const Shared<Derived>& other)
  noexcept : count_(other.count_), object_(other.object_) {
    if (count_ != nullptr) held_detail::join(count_);
  }
  Shared(Shared&& other) noexcept
      : count_(std::exchange(other.count_, nullptr)),
        object_(std::exchange(other.object_, nullptr)) {}
  Shared& operator=(Shared other) noexcept {
    std::swap(count_, other.count_);
    std::swap(object_, other.object_);
    return *this;
  }
  ~Shared() {
    if (count_ != nullptr) held_detail::leave(count_);
  }

  [[nodiscard]] T* get() const { return object_; }
  [[nodiscard]] T& operator*() const { return *object_; }
  [[nodiscard]] T* operator->() const { return object_; }
  [[nodiscard]] bool operator==(std::nullptr_t) const { return object_ == nullptr; }
  [[nodiscard]] bool operator==(const Shared& other) const { return object_ == other.object_; }

 private:
  template <class>
  friend class Shared;

  held_detail::Count* count_ = nullptr;
  T* object_ = nullptr;
};

/// A pointer that is null only in an object that was moved from; using it there throws
/// Error{invalid_argument}. `Pointer`: plain or an Owner.
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
