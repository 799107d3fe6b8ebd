// The data-parallel words on a CUDA device, by CCCL's Thrust. Thin on purpose: Thrust's algorithms
// are the words. Only for translation units that nvcc compiles.
//
// Work goes to the context's stream in order; a word that returns a value waits for it, the others
// return at once (par_nosync). Iterators are device-accessible; functors carry RASTRUM_HD. Thrust
// allocates its scratch from the device and throws std::bad_alloc, or thrust::system_error for
// whatever else the device reports.
#pragma once

#include <cstddef>

#include <cuda_runtime_api.h>
#include <thrust/execution_policy.h>
#include <thrust/for_each.h>
#include <thrust/gather.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/scatter.h>
#include <thrust/sort.h>
#include <thrust/transform.h>

namespace rastrum::parallel {

/// A stream of the current device. Does not own it; the default is the device's null stream.
struct Cuda {
  cudaStream_t stream = nullptr;

  [[nodiscard]] auto policy() const { return thrust::cuda::par_nosync.on(stream); }
};

/// Calls f(i) for i in [0, n). Work O(n), span O(1).
template <class F>
void for_each_index(Cuda& exec, std::size_t n, F f) {
  thrust::for_each_n(exec.policy(), thrust::counting_iterator<std::size_t>(0), n, f);
}

/// out[i] = f(in[i]). Work O(n), span O(1).
template <class In, class Out, class F>
void transform(Cuda& exec, In in, std::size_t n, Out out, F f) {
  thrust::transform(exec.policy(), in, in + n, out, f);
}

/// init ⊕ in[0] ⊕ … ⊕ in[n − 1], ⊕ associative and commutative. Work O(n), span O(log n); waits.
template <class In, class T, class Op>
[[nodiscard]] T reduce(Cuda& exec, In in, std::size_t n, T init, Op op) {
  return thrust::reduce(exec.policy(), in, in + n, init, op);
}

/// out[i] = init ⊕ in[0] ⊕ … ⊕ in[i − 1], ⊕ associative. Work O(n), span O(log n). In may be out.
template <class In, class Out, class T, class Op>
void exclusive_scan(Cuda& exec, In in, std::size_t n, Out out, T init, Op op) {
  thrust::exclusive_scan(exec.policy(), in, in + n, out, init, op);
}

/// out[i] = in[0] ⊕ … ⊕ in[i], ⊕ associative. Work O(n), span O(log n). In may be out.
template <class In, class Out, class Op>
void inclusive_scan(Cuda& exec, In in, std::size_t n, Out out, Op op) {
  thrust::inclusive_scan(exec.policy(), in, in + n, out, op);
}

/// out[i] = in[index[i]]. Work O(n), span O(1).
template <class Index, class In, class Out>
void gather(Cuda& exec, Index index, std::size_t n, In in, Out out) {
  thrust::gather(exec.policy(), index, index + n, in, out);
}

/// out[index[i]] = in[i], the indices distinct. Work O(n), span O(1).
template <class In, class Index, class Out>
void scatter(Cuda& exec, In in, std::size_t n, Index index, Out out) {
  thrust::scatter(exec.policy(), in, in + n, index, out);
}

/// Sorts the keys ascending and moves the values with them; equal keys keep their order.
/// Integer keys: radix sort, O(n · bits) work. Scratch O(n).
template <class Keys, class Values>
void sort_by_key(Cuda& exec, Keys keys, std::size_t n, Values values) {
  thrust::stable_sort_by_key(exec.policy(), keys, keys + n, values);
}

}  // namespace rastrum::parallel
