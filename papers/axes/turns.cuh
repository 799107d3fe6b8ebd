// SPDX-License-Identifier: BSD-3-Clause
// expand and expand_masked on a device in turns, so that only as many results are in memory as fit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include <papers/axes/names.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/stop.hpp>

namespace rastrum::family {

/// Functor: result k of an expansion.
template <class Plan, class In, class Get>
struct ResultOf {
  Plan plan;
  In in;
  Get get;
  RASTRUM_HD auto operator()(std::size_t k) const {
    const std::size_t i = plan.segment_of(k);
    return get(in[i], k - plan.first(i));
  }
};
/// The same for a masked expansion whose results have `parts` each: get(in[i], j, part).
template <class T, class Plan, class In, class Get>
struct MaskedPartOf {
  Plan plan;
  In in;
  Get get;
  std::size_t parts;
  RASTRUM_HD T operator()(std::size_t k) const {
    T result{};
    const std::size_t r = k / parts, part = k % parts;
    plan.walk(in, r, r + 1, [&](const auto& x, std::size_t j) { result = get(x, j, part); });
    return result;
  }
};

template <class At>
struct Behind {
  At at;
  std::size_t first;
  RASTRUM_HD auto operator()(std::size_t k) const { return at(first + k); }
};

/// Calls f(begin, end) for consecutive parts of [0, n) of at most `most`.
template <class F>
void each_turn(std::size_t n, std::size_t most, F&& f) {
  for (std::size_t begin = 0; begin < n;) {
    throw_if_stopped();
    const std::size_t end = begin + std::min(most, n - begin);
    f(begin, end);
    begin = end;
  }
}

/// Calls f(results) with at(k) for all k in [0, n), at most `most` at once. The results are a span
/// of device memory that lives as long as the call.
template <class Exec, class At, class F>
void tabulate_in_turns(Exec& exec, std::size_t n, const At& at, std::size_t most, F&& f) {
  using T = std::remove_cvref_t<decltype(at(std::size_t{0}))>;
  each_turn(n, most, [&](std::size_t begin, std::size_t end) {
    auto results = parallel::make_buffer<T>(exec, end - begin);
    parallel::tabulate(exec, results, Behind<At>{at, begin});
    f(parallel::view_of(std::as_const(results)));
  });
}

/// The same with expand(in, size, get). Returns the number of results. Work O((n + total) log n); 8
/// bytes for each of `in`.
template <class Exec, class T, class Size, class Get, class F>
std::uint64_t expand_in_turns(Exec& exec, std::span<const T> in, const Size& size, const Get& get,
                              std::size_t most, F&& f) {
  const auto expansion = parallel::make_expansion(exec, in, size);
  using Plan = decltype(expansion.view());
  tabulate_in_turns(exec, expansion.size(),
                    ResultOf<Plan, std::span<const T>, Get>{expansion.view(), in, get}, most, f);
  return expansion.size();
}

}  // namespace rastrum::family
