// SPDX-License-Identifier: BSD-3-Clause
// reduce, exclusive_scan and inclusive_scan on a device; definitions in reduce.hpp and scan.hpp.
//
// CUB computes them through Thrust where any order gives the same bits (kAnyOrder): work O(n), span
// O(log n). Otherwise a thread folds each block of kBlock elements, and one thread the blocks'
// results: span O(kBlock + n / kBlock), the CPU's bits. Allocates CUB's scratch or one T per block,
// and a scan's sum. reduce waits.
#pragma once

#include <cassert>
#include <cstddef>
#include <functional>
#include <span>
#include <type_traits>

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>

#include <rastrum/parallel/cuda/elementwise.cuh>
#include <rastrum/parallel/cuda/order.cuh>
#include <rastrum/parallel/scan.hpp>

namespace rastrum::parallel {
namespace cuda_detail {

template <class T, class View>
struct ReadAs {
  View view;
  RASTRUM_HD T operator()(std::size_t i) const { return static_cast<T>(view[i]); }
};

/// The elements of a view, converted to T, as an iterator.
template <class T, class View>
[[nodiscard]] auto values_as(const View& view) {
  return thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0),
                                         ReadAs<T, View>{view});
}
template <class T>
[[nodiscard]] const T* values_as(const std::span<T>& view) {
  return view.data();
}
template <class T>
[[nodiscard]] const T* values_as(const std::span<const T>& view) {
  return view.data();
}

/// The elements as T, with `initial` folded into the first: Thrust's inclusive scan takes no
/// initial value before CUDA 12.8.
template <class T, class View, class Op>
struct ReadBehind {
  View view;
  T initial;
  Op op;
  RASTRUM_HD T operator()(std::size_t i) const {
    if (i > 0) return static_cast<T>(view[i]);
    Op plus = op;
    return static_cast<T>(plus(initial, static_cast<T>(view[0])));
  }
};

template <class T, class In, class Op>
struct FoldBlock {
  In in;
  std::span<T> partial;
  Op op;
  RASTRUM_HD void operator()(std::size_t block, std::size_t begin, std::size_t end) const {
    Op plus = op;
    partial[block] = fold_block<T>(in, begin, end, plus);
  }
};

/// Replaces each block's result by the fold of all before it. Runs on one thread.
template <class T, class Op>
struct FoldPartials {
  std::span<T> partial;
  T initial;
  Op op;
  T* total;
  RASTRUM_HD void operator()(std::size_t) const {
    Op plus = op;
    T sum = initial;
    for (T& p : partial) {
      const T block = p;
      p = sum;
      sum = static_cast<T>(plus(sum, block));
    }
    *total = sum;
  }
};

template <bool kInclusive, class T, class In, class Out, class Op>
struct ScanBlock {
  In in;
  Out out;
  std::span<const T> before;
  Op op;
  RASTRUM_HD void operator()(std::size_t block, std::size_t begin, std::size_t end) const {
    Op plus = op;
    Out to = out;
    scan_detail::scan_block<kInclusive>(in, to, begin, end, before[block], plus);
  }
};

/// An exclusive scan's result lacks the last element of `in`. `out` may be `in`, so KeepLast saves
/// that element to *total before the scan, and AddLast adds the result's last to it.
template <class T, class In>
struct KeepLast {
  In in;
  std::size_t n;
  T* total;
  RASTRUM_HD void operator()(std::size_t) const { *total = static_cast<T>(in[n - 1]); }
};
template <class T, class Out, class Op>
struct AddLast {
  Out out;
  std::size_t n;
  T* total;
  Op op;
  RASTRUM_HD void operator()(std::size_t) const {
    Op plus = op;
    *total = static_cast<T>(plus(static_cast<T>(out[n - 1]), *total));
  }
};

/// Folds the blocks of `in`. Returns the fold of all before each block; *total becomes that of all.
template <class T, class In, class Op>
[[nodiscard]] DeviceBuffer<T> fold_blocks(Cuda& exec, In in, T initial, Op op, T* total) {
  const std::size_t n = std::size(in);
  auto partial = make_buffer<T>(exec, block_count(n));
  for_each_block(exec, n, FoldBlock<T, In, Op>{in, view_of(partial), op});
  for_each_index(exec, 1, FoldPartials<T, Op>{view_of(partial), initial, op, total});
  return partial;
}

template <bool kInclusive, class In, class Out, class T, class Op>
Pending<T> scan(Cuda& exec, In in, Out out, T initial, Op op) {
  const std::size_t n = std::size(in);
  auto total = make_buffer<T>(exec, 1);
  if (!kAnyOrder<T, Op> || n == 0) {
    const auto before = fold_blocks(exec, in, initial, op, total.data());
    for_each_block(exec, n, ScanBlock<kInclusive, T, In, Out, Op>{in, out, view_of(before), op});
  } else {
    if constexpr (kInclusive) {
      const auto values = thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0),
                                                          ReadBehind<T, In, Op>{in, initial, op});
      thrust::inclusive_scan(exec.policy(), values, values + static_cast<std::ptrdiff_t>(n),
                             std::data(out), op);
      for_each_index(exec, 1, KeepLast<T, Out>{out, n, total.data()});
    } else {
      const auto values = values_as<T>(in);
      for_each_index(exec, 1, KeepLast<T, In>{in, n, total.data()});
      thrust::exclusive_scan(exec.policy(), values, values + static_cast<std::ptrdiff_t>(n),
                             std::data(out), initial, op);
      for_each_index(exec, 1, AddLast<T, Out, Op>{out, n, total.data(), op});
    }
  }
  return {exec, std::move(total)};
}

}  // namespace cuda_detail

template <Readable In, class T, class Op = std::plus<>>
[[nodiscard]] T reduce(Cuda& exec, const In& in, T initial, Op op = {}) {
  auto view = device_view(in);
  if constexpr (kAnyOrder<T, Op>) {
    const auto values = cuda_detail::values_as<T>(view);
    return thrust::reduce(exec.policy(), values,
                          values + static_cast<std::ptrdiff_t>(std::size(in)), initial, op);
  } else {
    auto total = make_buffer<T>(exec, 1);
    static_cast<void>(cuda_detail::fold_blocks(exec, view, initial, op, total.data()));
    return to_host(exec, total)[0];
  }
}

/// `out` is contiguous and may be `in`. Reading the sum waits.
template <Readable In, Writable Out, class T, class Op = std::plus<>>
Pending<T> exclusive_scan(Cuda& exec, const In& in, Out&& out, T initial, Op op = {}) {
  assert(std::size(in) == std::size(out));
  return cuda_detail::scan<false>(exec, device_view(in), device_view(out), initial, op);
}

template <Readable In, Writable Out, class T, class Op = std::plus<>>
Pending<T> inclusive_scan(Cuda& exec, const In& in, Out&& out, T initial, Op op = {}) {
  assert(std::size(in) == std::size(out));
  return cuda_detail::scan<true>(exec, device_view(in), device_view(out), initial, op);
}

}  // namespace rastrum::parallel
