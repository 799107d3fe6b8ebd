// The data-parallel words on a CUDA device, by CCCL's Thrust. Thin on purpose: Thrust's algorithms
// are the words. Only for translation units that nvcc compiles. Never run yet
// (docs/architecture.md).
//
// Ranges are views of device memory and are copied into kernels: std::span over device pointers, or
// anything small with a size and an operator[] that the device can call. Functors carry RASTRUM_HD.
// Work goes to the context's stream in order; a word that returns a value waits for it, the others
// return at once (par_nosync). Thrust allocates its scratch on the device and throws
// std::bad_alloc, or thrust::system_error for whatever else the device reports.
#pragma once

#include <cassert>
#include <cstddef>
#include <functional>
#include <iterator>

#include <cuda_runtime_api.h>
#include <thrust/execution_policy.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/sort.h>

#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// A stream of the current device. Does not own it; the default is the device's null stream.
struct Cuda {
  cudaStream_t stream = nullptr;

  [[nodiscard]] auto policy() const { return thrust::cuda::par_nosync.on(stream); }
};

namespace cuda_detail {

template <class R>
struct ReadAt {
  R range;
  RASTRUM_HD element_t<R> operator()(std::size_t i) const { return range[i]; }
};

/// A range as an iterator over its elements' values.
template <class R>
[[nodiscard]] auto values_of(const R& range) {
  return thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0),
                                         ReadAt<R>{range});
}

template <class Out, class F>
struct Assign {
  Out out;
  F f;
  RASTRUM_HD void operator()(std::size_t i) const { out[i] = f(i); }
};

template <class In, class F>
struct Apply {
  In in;
  F f;
  RASTRUM_HD auto operator()(std::size_t i) const { return f(in[i]); }
};

template <class In, class Map>
struct ReadThrough {
  In in;
  Map map;
  RASTRUM_HD element_t<In> operator()(std::size_t i) const {
    return in[static_cast<std::size_t>(map[i])];
  }
};

template <class In, class Map, class Out>
struct WriteThrough {
  In in;
  Map map;
  Out out;
  RASTRUM_HD void operator()(std::size_t i) const { out[static_cast<std::size_t>(map[i])] = in[i]; }
};

}  // namespace cuda_detail

/// Calls f(i) for i in [0, n). Work O(n), span O(1).
template <class F>
void for_each_index(Cuda& exec, std::size_t n, F f) {
  thrust::for_each_n(exec.policy(), thrust::counting_iterator<std::size_t>(0), n, f);
}

/// out[i] = f(i). Work O(n), span O(1).
template <Writable Out, class F>
void tabulate(Cuda& exec, Out out, F f) {
  for_each_index(exec, std::size(out), cuda_detail::Assign<Out, F>{out, f});
}

/// out[i] = f(in[i]); `out` may be `in`. Work O(n), span O(1).
template <Readable In, Writable Out, class F>
void transform(Cuda& exec, In in, Out out, F f) {
  assert(std::size(in) == std::size(out));
  tabulate(exec, out, cuda_detail::Apply<In, F>{in, f});
}

/// in[0] op … op in[n − 1] behind `initial`. Unlike the CPU's, `op` must commute too, and the bits
/// of a sum of floats are Thrust's choice. Work O(n), span O(log n); waits.
template <Readable In, class T, class Op = std::plus<>>
[[nodiscard]] T reduce(Cuda& exec, In in, T initial, Op op = {}) {
  const auto values = cuda_detail::values_of(in);
  return thrust::reduce(exec.policy(), values, values + std::size(in), initial, op);
}

/// out[i] = initial op in[0] op … op in[i − 1]; `out` is contiguous and may be `in`.
/// Work O(n), span O(log n).
template <Readable In, Writable Out, class T, class Op = std::plus<>>
void exclusive_scan(Cuda& exec, In in, Out out, T initial, Op op = {}) {
  assert(std::size(in) == std::size(out));
  const auto values = cuda_detail::values_of(in);
  thrust::exclusive_scan(exec.policy(), values, values + std::size(in), std::data(out), initial,
                         op);
}

/// out[i] = initial op in[0] op … op in[i]; otherwise the same.
template <Readable In, Writable Out, class T, class Op = std::plus<>>
void inclusive_scan(Cuda& exec, In in, Out out, T initial, Op op = {}) {
  assert(std::size(in) == std::size(out));
  const auto values = cuda_detail::values_of(in);
  thrust::inclusive_scan(exec.policy(), values, values + std::size(in), std::data(out), initial,
                         op);
}

/// out[i] = in[map[i]]; no overlap. Work O(n), span O(1).
template <Readable In, Readable Map, Writable Out>
void gather(Cuda& exec, In in, Map map, Out out) {
  assert(std::size(map) == std::size(out));
  tabulate(exec, out, cuda_detail::ReadThrough<In, Map>{in, map});
}

/// out[map[i]] = in[i], the indices distinct; no overlap. Work O(n), span O(1).
template <Readable In, Readable Map, Writable Out>
void scatter(Cuda& exec, In in, Map map, Out out) {
  assert(std::size(in) == std::size(map));
  for_each_index(exec, std::size(in), cuda_detail::WriteThrough<In, Map, Out>{in, map, out});
}

/// Sorts contiguous `keys` ascending and moves `values` with them; equal keys keep their order.
/// Unsigned keys: radix sort, O(n · bits) work. Scratch O(n) on the device.
template <class Keys, class Values>
void sort_by_key(Cuda& exec, Keys keys, Values values) {
  assert(std::size(keys) == std::size(values));
  thrust::stable_sort_by_key(exec.policy(), std::data(keys), std::data(keys) + std::size(keys),
                             std::data(values));
}

}  // namespace rastrum::parallel
