// SPDX-License-Identifier: BSD-3-Clause
// filter and partition on a device; definitions in filter.hpp and partition.hpp.
//
// The predicate runs once per element and is kept as a byte. We count the bytes to allocate the
// result (waits); then Thrust's copy_if or stable_partition_copy moves the elements. Work O(n),
// span O(log n). Allocates the result, n bytes and CUB's scratch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <thrust/copy.h>
#include <thrust/partition.h>

#include <rastrum/parallel/cuda/reduce.cuh>

namespace rastrum::parallel {
namespace cuda_detail {

template <class In, class Predicate>
struct Holds {
  In in;
  Predicate holds;
  RASTRUM_HD std::uint8_t operator()(std::size_t i) const {
    return static_cast<bool>(holds(in[i])) ? std::uint8_t{1} : std::uint8_t{0};
  }
};
struct IsSet {
  RASTRUM_HD bool operator()(std::uint8_t flag) const { return flag != 0; }
};

struct Flags {
  DeviceBuffer<std::uint8_t> flags;
  std::size_t count;
};
template <class View, class Predicate>
[[nodiscard]] Flags flag_elements(Cuda& exec, View view, Predicate holds) {
  Flags out{make_buffer<std::uint8_t>(exec, std::size(view)), 0};
  tabulate(exec, out.flags, Holds<View, Predicate>{view, holds});
  out.count = reduce(exec, out.flags, std::size_t{0});
  return out;
}

}  // namespace cuda_detail

template <Readable In, class Predicate>
[[nodiscard]] DeviceBuffer<element_t<In>> filter(Cuda& exec, const In& in, Predicate&& holds) {
  using T = element_t<In>;
  auto view = device_view(in);
  const auto flagged =
      cuda_detail::flag_elements<decltype(view), std::decay_t<Predicate>>(exec, view, holds);
  auto out = make_buffer<T>(exec, flagged.count);
  const auto values = cuda_detail::values_as<T>(view);
  thrust::copy_if(exec.policy(), values, values + static_cast<std::ptrdiff_t>(std::size(in)),
                  flagged.flags.data(), out.data(), cuda_detail::IsSet{});
  return out;
}

template <class T>
struct DevicePartition {
  DeviceBuffer<T> elements;
  std::size_t first_count = 0;  ///< the number of elements for which the predicate holds
};

template <Readable In, class Predicate>
[[nodiscard]] DevicePartition<element_t<In>> partition(Cuda& exec, const In& in,
                                                       Predicate&& holds) {
  using T = element_t<In>;
  auto view = device_view(in);
  const auto flagged =
      cuda_detail::flag_elements<decltype(view), std::decay_t<Predicate>>(exec, view, holds);
  DevicePartition<T> out{make_buffer<T>(exec, std::size(in)), flagged.count};
  const auto values = cuda_detail::values_as<T>(view);
  thrust::stable_partition_copy(exec.policy(), values,
                                values + static_cast<std::ptrdiff_t>(std::size(in)),
                                flagged.flags.data(), out.elements.data(),
                                out.elements.data() + flagged.count, cuda_detail::IsSet{});
  return out;
}

}  // namespace rastrum::parallel
