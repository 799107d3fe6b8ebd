// SPDX-License-Identifier: BSD-3-Clause
// Ranges, which words read and write, have a size and an operator[]: vectors, arrays, spans. The
// small ones below compute their elements when read (paper 5, appendix A: counting, permute,
// constant), so that no word needs a second form for them.
#pragma once

#include <concepts>
#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/config.hpp>

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

/// i ↦ f(i) for i in [0, n), computed at every read.
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

namespace range_detail {

// These are named, because a kernel's arguments may not have the type of a host lambda.
template <class Integer>
struct IndexItself {
  [[nodiscard]] RASTRUM_HD constexpr Integer operator()(std::size_t i) const {
    return static_cast<Integer>(i);
  }
};
template <class T>
struct SameValue {
  T value;
  [[nodiscard]] RASTRUM_HD constexpr T operator()(std::size_t) const { return value; }
};

template <class R>
inline constexpr bool kIsView = false;
template <class T>
inline constexpr bool kIsView<std::span<T>> = true;
template <class F>
inline constexpr bool kIsView<Computed<F>> = true;
/// Views are copied, as devices require; containers are referred to.
template <class R>
using borrowed_t = std::conditional_t<kIsView<R>, R, const R&>;

template <class Source, class Map>
struct ReadThrough {
  borrowed_t<Source> source;
  borrowed_t<Map> map;
  [[nodiscard]] RASTRUM_HD constexpr decltype(auto) operator()(std::size_t i) const {
    return source[static_cast<std::size_t>(map[i])];
  }
};

}  // namespace range_detail

/// 0, 1, …, n − 1.
template <class Integer = std::size_t>
[[nodiscard]] RASTRUM_HD constexpr auto counting(std::size_t n) {
  return Computed(n, range_detail::IndexItself<Integer>{});
}

/// `value`, n times.
template <class T>
[[nodiscard]] RASTRUM_HD constexpr auto constant(std::size_t n, T value) {
  return Computed(n, range_detail::SameValue<T>{value});
}

/// source[map[i]]; refers to both, or copies them if they are views.
template <Readable Source, Readable Map>
[[nodiscard]] RASTRUM_HD constexpr auto permuted(const Source& source, const Map& map) {
  return Computed(std::size(map), range_detail::ReadThrough<Source, Map>{source, map});
}

/// Refers to a range without data().
template <class R>
struct Referred {
  R* range;
  [[nodiscard]] constexpr std::size_t size() const { return std::size(*range); }
  [[nodiscard]] constexpr decltype(auto) operator[](std::size_t i) const { return (*range)[i]; }
};

/// A cheap copy for functors: a span of a container, a copy of a view. The range must outlive it.
template <class R>
[[nodiscard]] constexpr auto view_of(R&& range) {
  using Plain = std::remove_cvref_t<R>;
  if constexpr (range_detail::kIsView<Plain>)
    return Plain(range);
  else if constexpr (requires { std::data(range); })
    return std::span(std::data(range), std::size(range));
  else
    return Referred<std::remove_reference_t<R>>{&range};
}
template <class R>
using view_t = decltype(view_of(std::declval<R>()));

}  // namespace rastrum::parallel
