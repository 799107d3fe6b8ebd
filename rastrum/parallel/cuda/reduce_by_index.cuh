// SPDX-License-Identifier: BSD-3-Clause
// reduce_by_index on a device; definition in reduce_by_index.hpp.
//
// The 64-bit maximum uses the device's atomic in place: work O(n), span O(1) beside contention.
// Other functions sort and reduce runs as on the CPU.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/cuda/by_key.cuh>
#include <rastrum/parallel/cuda/sort_by_key.cuh>
#include <rastrum/parallel/reduce_by_index.hpp>

namespace rastrum::parallel {
namespace cuda_detail {

template <class Index>
[[nodiscard]] RASTRUM_HD constexpr bool in_range(Index index, std::size_t bins) {
  if constexpr (std::is_signed_v<Index>)
    if (index < 0) return false;
  return static_cast<std::size_t>(index) < bins;
}

template <class Dest, class Indices, class Values>
struct MaximumInPlace {
  Dest dest;
  Indices indices;
  Values values;
  RASTRUM_HD void operator()(std::size_t i) const {
    if (in_range(indices[i], dest.size()))
      atomic_maximum(dest[static_cast<std::size_t>(indices[i])],
                     static_cast<std::uint64_t>(values[i]));
  }
};
template <class Indices>
struct IndexInRange {
  Indices indices;
  std::size_t bins;
  RASTRUM_HD bool operator()(std::size_t i) const { return in_range(indices[i], bins); }
};
template <class Indices>
struct KeyAt {
  Indices indices;
  RASTRUM_HD std::size_t operator()(std::size_t i) const {
    return static_cast<std::size_t>(indices[i]);
  }
};
template <class T, class Values>
struct ValueAt {
  Values values;
  std::span<const std::size_t> position;
  RASTRUM_HD T operator()(std::size_t k) const { return static_cast<T>(values[position[k]]); }
};
template <class Dest, class T, class Op>
struct FoldIntoBin {
  Dest dest;
  std::span<const std::size_t> keys;
  std::span<const T> sums;
  Op op;
  RASTRUM_HD void operator()(std::size_t k) const {
    Op plus = op;
    T& bin = dest[keys[k]];
    bin = static_cast<T>(plus(bin, sums[k]));
  }
};

}  // namespace cuda_detail

template <Writable Dest, Readable Indices, Readable Values, class Op>
void reduce_by_index(Cuda& exec, Dest&& dest, const Indices& indices, const Values& values, Op op) {
  using T = std::remove_cvref_t<decltype(dest[0])>;
  assert(std::size(indices) == std::size(values));
  auto to = device_view(dest);
  auto at = device_view(indices);
  auto from = device_view(values);
  const std::size_t n = std::size(indices), bins = std::size(dest);
  if constexpr (std::is_same_v<T, std::uint64_t> && std::is_same_v<Op, Maximum>) {
    for_each_index(
        exec, n,
        cuda_detail::MaximumInPlace<decltype(to), decltype(at), decltype(from)>{to, at, from});
  } else {
    auto position = filter(exec, counting(n), cuda_detail::IndexInRange<decltype(at)>{at, bins});
    auto key = make_buffer<std::size_t>(exec, position.size());
    transform(exec, position, key, cuda_detail::KeyAt<decltype(at)>{at});
    sort_by_key(exec, key, position, static_cast<int>(std::bit_width(bins)));
    const auto sums = reduce_by_key(
        exec, key,
        Computed(position.size(), cuda_detail::ValueAt<T, decltype(from)>{from, view_of(position)}),
        op);
    for_each_index(exec, sums.keys.size(),
                   cuda_detail::FoldIntoBin<decltype(to), T, Op>{to, view_of(sums.keys),
                                                                 view_of(sums.values), op});
  }
}

}  // namespace rastrum::parallel
