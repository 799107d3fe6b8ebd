// SPDX-License-Identifier: BSD-3-Clause
// for_each, tabulate, transform, scatter, scatter_if and transpose on a device, a thread per
// element. Definitions as on the CPU.
//
// Work O(n), span O(1). Allocate nothing, do not wait.
#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/cuda/buffer.cuh>

namespace rastrum::parallel {
namespace cuda_detail {

template <class Range, class F>
struct CallWithElement {
  Range range;
  F f;
  RASTRUM_HD void operator()(std::size_t i) const { f(range[i]); }
};
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
  RASTRUM_HD decltype(auto) operator()(std::size_t i) const { return f(in[i]); }
};
template <class In, class Map, class Stencil, class Out>
struct WriteThrough {
  In in;
  Map map;
  Stencil stencil;
  Out out;
  RASTRUM_HD void operator()(std::size_t i) const {
    if (static_cast<bool>(stencil[i])) out[static_cast<std::size_t>(map[i])] = in[i];
  }
};
template <class In>
struct Transposed {
  In in;
  std::size_t rows, columns;
  RASTRUM_HD decltype(auto) operator()(std::size_t i) const {
    return in[i % rows * columns + i / rows];
  }
};

}  // namespace cuda_detail

template <class F>
void for_each_block(Cuda& exec, std::size_t n, F&& f) {
  for_each_index(exec, block_count(n), CallWithBlock<std::decay_t<F>>{n, f});
}

template <Readable Range, class F>
void for_each(Cuda& exec, Range&& range, F&& f) {
  auto view = device_view(range);
  for_each_index(exec, std::size(range),
                 cuda_detail::CallWithElement<decltype(view), std::decay_t<F>>{view, f});
}

template <Writable Out, class F>
void tabulate(Cuda& exec, Out&& out, F&& f) {
  auto view = device_view(out);
  for_each_index(exec, std::size(out),
                 cuda_detail::Assign<decltype(view), std::decay_t<F>>{view, f});
}

/// Zeros all bytes of `buffer`, faster than a thread per element does.
template <class T>
void clear(Cuda& exec, DeviceBuffer<T>& buffer) {
  static_assert(std::is_integral_v<T>);
  if (buffer.size() > 0)
    cuda_system::clear(exec.stream(), buffer.data(), buffer.size() * sizeof(T));
}

template <Readable In, Writable Out, class F>
void transform(Cuda& exec, const In& in, Out&& out, F&& f) {
  assert(std::size(in) == std::size(out));
  auto view = device_view(in);
  tabulate(exec, out, cuda_detail::Apply<decltype(view), std::decay_t<F>>{view, f});
}

template <Readable In, Readable Map, Readable Stencil, Writable Out>
void scatter_if(Cuda& exec, const In& in, const Map& map, const Stencil& stencil, Out&& out) {
  assert(std::size(in) == std::size(map) && std::size(in) == std::size(stencil));
  auto from = device_view(in);
  auto at = device_view(map);
  auto when = device_view(stencil);
  auto to = device_view(out);
  for_each_index(
      exec, std::size(in),
      cuda_detail::WriteThrough<decltype(from), decltype(at), decltype(when), decltype(to)>{
          from, at, when, to});
}

template <Readable In, Readable Map, Writable Out>
void scatter(Cuda& exec, const In& in, const Map& map, Out&& out) {
  scatter_if(exec, in, map, constant(std::size(in), true), out);
}

/// Writes in order; the scattered reads share cache lines.
template <Readable In, Writable Out>
void transpose(Cuda& exec, const In& in, std::size_t rows, std::size_t columns, Out&& out) {
  assert(std::size(in) == rows * columns && std::size(out) == rows * columns);
  auto from = device_view(in);
  tabulate(exec, out, cuda_detail::Transposed<decltype(from)>{from, rows, columns});
}

}  // namespace rastrum::parallel
