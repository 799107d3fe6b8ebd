// SPDX-License-Identifier: BSD-3-Clause
// reduce_by_key and segmented_scan on a device; definitions in reduce_by_key.hpp and segmented.hpp.
//
// Thrust computes them where any order (for the scan, any grouping) gives the same bits; a binary
// search finds each element's segment: work O(n · log segments), span O(log n). Otherwise the CPU's
// passes run, a thread per block of kBlock elements. reduce_by_key waits for the number of runs.
#pragma once

#include <cassert>
#include <cstddef>
#include <functional>
#include <type_traits>

#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/parallel/cuda/select.cuh>
#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/reduce_by_key.hpp>
#include <rastrum/parallel/segmented.hpp>

namespace rastrum::parallel {
namespace cuda_detail {

template <class First>
struct SegmentOf {
  First first;
  RASTRUM_HD std::size_t operator()(std::size_t i) const {
    return expand_detail::last_at_most(first, i);
  }
};
template <class Keys>
struct IsHead {
  Keys keys;
  RASTRUM_HD std::size_t operator()(std::size_t i) const {
    return by_key_detail::is_head(keys, i) ? 1 : 0;
  }
};

}  // namespace cuda_detail

template <class K, class V>
struct DeviceReducedByKey {
  DeviceBuffer<K> keys;
  DeviceBuffer<V> values;
};

template <Readable Keys, Readable Values, class Op = std::plus<>>
[[nodiscard]] DeviceReducedByKey<element_t<Keys>, element_t<Values>> reduce_by_key(
    Cuda& exec, const Keys& keys, const Values& values, Op op = {}) {
  using K = element_t<Keys>;
  using V = element_t<Values>;
  assert(std::size(keys) == std::size(values));
  auto key_view = device_view(keys);
  auto value_view = device_view(values);
  if constexpr (kAnyOrder<V, Op>) {
    const std::size_t n = std::size(keys);
    const std::size_t runs = reduce(
        exec, Computed(n, cuda_detail::IsHead<decltype(key_view)>{key_view}), std::size_t{0});
    DeviceReducedByKey<K, V> out{make_buffer<K>(exec, runs), make_buffer<V>(exec, runs)};
    const auto key = cuda_detail::values_as<K>(key_view);
    thrust::reduce_by_key(exec.policy(), key, key + static_cast<std::ptrdiff_t>(n),
                          cuda_detail::values_as<V>(value_view), out.keys.data(), out.values.data(),
                          std::equal_to<>{}, op);
    return out;
  } else {
    return by_key_detail::reduce_in_blocks<DeviceReducedByKey<K, V>, K, V>(exec, key_view,
                                                                           value_view, op);
  }
}

/// `out` is contiguous and may be `in`.
template <class T, Readable First, Readable In, Writable Out, class Op = std::plus<>>
void segmented_scan(Cuda& exec, const First& first, const In& in, Out&& out, Op op = {}) {
  assert(std::size(in) == std::size(out));
  auto begins = device_view(first);
  auto view = device_view(in);
  auto to = device_view(out);
  if constexpr (kAnyGrouping<T, Op>) {
    const auto segment = cuda_detail::values_as<std::size_t>(
        Computed(std::size(in), cuda_detail::SegmentOf<decltype(begins)>{begins}));
    thrust::inclusive_scan_by_key(
        exec.policy(), segment, segment + static_cast<std::ptrdiff_t>(std::size(in)),
        cuda_detail::values_as<T>(view), to.data(), std::equal_to<>{}, op);
  } else {
    segmented_detail::scan_in_blocks<T>(exec, begins, view, to, op);
  }
}

}  // namespace rastrum::parallel
