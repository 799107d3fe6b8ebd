// What words read and write: anything with a size and an operator[]. Vectors, arrays and spans are
// ranges; so are the small ones below, which are computed where they are read (paper 5, appendix A:
// counting, permute, constant, discard), so that no word needs a second form for them.
#pragma once

#include <concepts>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/core/config.hpp>

namespace rastrum::parallel {

template <class R>
concept Readable = requires(const std::remove_reference_t<R>& r, std::size_t i) {
  r[i];
  { std::size(r) } -> std::convertible_to<std::size_t>;
};

template <class R>
using element_t =
    std::remove_cvref_t<decltype(std::declval<const std::remove_reference_t<R>&>()[0])>;

template <class R>
concept Writable = requires(R& r, std::size_t i) {
  r[i];
  { std::size(r) } -> std::convertible_to<std::size_t>;
}
&&!std::same_as<std::remove_cvref_t<R>, std::vector<bool>>;

/// i ↦ f(i) for i in [0, n), computed at every reading.
template <class F>
class Computed {
 public:
  RASTRUM_HD constexpr Computed(std::size_t n, F f) : n_(n), f_(std::move(f)) {}
  [[nodiscard]] RASTRUM_HD constexpr std::size_t size() const { return n_; }
  [[nodiscard]] RASTRUM_HD constexpr decltype(auto) operator[](std::size_t i) const {
    return f_(i);
  }

 private:
  std::size_t n_;
  F f_;
};

/// 0, 1, …, n − 1.
template <class Integer = std::size_t>
[[nodiscard]] RASTRUM_HD constexpr auto counting(std::size_t n) {
  return Computed(n, [](std::size_t i) { return static_cast<Integer>(i); });
}

/// `value`, n times.
template <class T>
[[nodiscard]] RASTRUM_HD constexpr auto constant(std::size_t n, T value) {
  return Computed(n, [value](std::size_t) { return value; });
}

/// source[map[i]]; borrows both.
template <Readable Source, Readable Map>
[[nodiscard]] RASTRUM_HD constexpr auto permuted(const Source& source, const Map& map) {
  return Computed(std::size(map), [&source, &map](std::size_t i) -> decltype(auto) {
    return source[static_cast<std::size_t>(map[i])];
  });
}

/// Takes n values and keeps none.
class Discard {
 public:
  struct Nowhere {
    template <class T>
    RASTRUM_HD constexpr const Nowhere& operator=(const T&) const {
      return *this;
    }
  };
  RASTRUM_HD constexpr explicit Discard(std::size_t n) : n_(n) {}
  [[nodiscard]] RASTRUM_HD constexpr std::size_t size() const { return n_; }
  [[nodiscard]] RASTRUM_HD constexpr Nowhere operator[](std::size_t) const { return {}; }

 private:
  std::size_t n_;
};

}  // namespace rastrum::parallel
