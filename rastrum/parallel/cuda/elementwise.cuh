// for_each, tabulate, transform, gather, scatter, scatter_if, index_in_group and transpose on a
// device: a thread an element. Definitions are those of the words of the same names on the CPU.
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
template <class A, class B, class F>
struct ApplyToBoth {
  A a;
  B b;
  F f;
  RASTRUM_HD decltype(auto) operator()(std::size_t i) const { return f(a[i], b[i]); }
};
template <class In, class Map>
struct ReadThrough {
  In in;
  Map map;
  RASTRUM_HD decltype(auto) operator()(std::size_t i) const {
    return in[static_cast<std::size_t>(map[i])];
  }
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
template <class Index, class Group, class First>
struct PlaceInGroup {
  Group group;
  First first;
  RASTRUM_HD Index operator()(std::size_t i) const {
    return static_cast<Index>(i -
                              static_cast<std::size_t>(first[static_cast<std::size_t>(group[i])]));
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

template <Readable In, Writable Out, class F>
void transform(Cuda& exec, const In& in, Out&& out, F&& f) {
  assert(std::size(in) == std::size(out));
  auto view = device_view(in);
  tabulate(exec, out, cuda_detail::Apply<decltype(view), std::decay_t<F>>{view, f});
}

template <Readable A, Readable B, Writable Out, class F>
void transform(Cuda& exec, const A& a, const B& b, Out&& out, F&& f) {
  assert(std::size(a) == std::size(out) && std::size(b) == std::size(out));
  auto a_view = device_view(a);
  auto b_view = device_view(b);
  tabulate(exec, out,
           cuda_detail::ApplyToBoth<decltype(a_view), decltype(b_view), std::decay_t<F>>{
               a_view, b_view, f});
}

template <Readable In, Readable Map, Writable Out>
void gather(Cuda& exec, const In& in, const Map& map, Out&& out) {
  assert(std::size(map) == std::size(out));
  auto from = device_view(in);
  auto at = device_view(map);
  tabulate(exec, out, cuda_detail::ReadThrough<decltype(from), decltype(at)>{from, at});
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

template <Readable Group, Readable First, Writable Out>
void index_in_group(Cuda& exec, const Group& group, const First& first, Out&& out) {
  assert(std::size(group) == std::size(out));
  using Index = std::remove_cvref_t<decltype(out[0])>;
  auto of = device_view(group);
  auto from = device_view(first);
  tabulate(exec, out, cuda_detail::PlaceInGroup<Index, decltype(of), decltype(from)>{of, from});
}

/// Writes in order; what it reads lies apart, and meets in the cache.
template <Readable In, Writable Out>
void transpose(Cuda& exec, const In& in, std::size_t rows, std::size_t columns, Out&& out) {
  assert(std::size(in) == rows * columns && std::size(out) == rows * columns);
  auto from = device_view(in);
  tabulate(exec, out, cuda_detail::Transposed<decltype(from)>{from, rows, columns});
}

}  // namespace rastrum::parallel
