// SPDX-License-Identifier: BSD-3-Clause
// expand, expand_masked and their walks on a device. They run the code of expand_each.hpp and
// masked_expansion.hpp, a thread per chunk.
//
// By default a chunk is one result, found by binary search, so that neighbouring threads write
// neighbouring results. Each thread asks the predicates of one mask.
//
// Work O((n + total) log n), span O(per_chunk + log n). Allocates as on the CPU, and 8 bytes per
// mask. Expansions wait for their size.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/parallel/expand.hpp>
#include <rastrum/parallel/expand_masked.hpp>

namespace rastrum::parallel {

template <>
inline constexpr std::size_t kResultsPerChunk<Cuda> = 1;
template <>
inline constexpr std::size_t kElementsPerGroup<Cuda> = 1;

using DeviceExpansion = BasicExpansion<DeviceBuffer<std::size_t>>;
template <int kBits>
using DeviceMaskedExpansion =
    BasicMaskedExpansion<kBits, DeviceBuffer<Mask<kBits>>, DeviceBuffer<std::size_t>>;

namespace cuda_detail {

template <class Chunk, class Plan, class In, class F>
struct CallWithChunk {
  Plan plan;
  In in;
  F f;
  RASTRUM_HD void operator()(std::size_t c) const { f(Chunk(plan, in, c)); }
};
template <class F>
struct CallWithEach {
  F f;
  template <class Chunk>
  RASTRUM_HD void operator()(const Chunk& chunk) const {
    const std::size_t c = chunk.index();
    chunk.each([&](const auto& element, std::size_t j) { f(c, element, j); });
  }
};
template <class Get, class T>
struct WriteEach {
  Get get;
  T* out;
  template <class Chunk>
  RASTRUM_HD void operator()(const Chunk& chunk) const {
    std::size_t k = chunk.begin();
    chunk.each([&](const auto& element, std::size_t j) { out[k++] = get(element, j); });
  }
};

}  // namespace cuda_detail

template <Readable In, class F>
void expand_chunks(Cuda& exec, const DeviceExpansion& expansion, const In& in, F&& f) {
  assert(std::size(in) == expansion.segments());
  using InView = decltype(device_view(in));
  using Plan = decltype(expansion.view());
  for_each_index(
      exec, expansion.chunks(),
      cuda_detail::CallWithChunk<ExpansionChunk<InView, Plan>, Plan, InView, std::decay_t<F>>{
          expansion.view(), device_view(in), f});
}
template <int kBits, Readable In, class F>
void expand_chunks(Cuda& exec, const DeviceMaskedExpansion<kBits>& expansion, const In& in, F&& f) {
  assert(std::size(in) == expansion.segments());
  using InView = decltype(device_view(in));
  using Plan = decltype(expansion.view());
  for_each_index(
      exec, expansion.chunks(),
      cuda_detail::CallWithChunk<MaskedChunk<kBits, InView, Plan>, Plan, InView, std::decay_t<F>>{
          expansion.view(), device_view(in), f});
}

template <Readable In, class F>
void expand_each(Cuda& exec, const DeviceExpansion& expansion, const In& in, F&& f) {
  expand_chunks(exec, expansion, in, cuda_detail::CallWithEach<std::decay_t<F>>{f});
}
template <Readable In, class Size, class Get>
[[nodiscard]] DeviceBuffer<expanded_t<In, Get>> expand(Cuda& exec, const In& in, Size&& size,
                                                       Get&& get) {
  using T = expanded_t<In, Get>;
  const auto expansion = make_expansion(exec, in, size);
  auto out = make_buffer<T>(exec, expansion.size());
  expand_chunks(exec, expansion, in, cuda_detail::WriteEach<std::decay_t<Get>, T>{get, out.data()});
  return out;
}

template <int kBits = 64, Readable In, class Size, class Holds, class Get>
[[nodiscard]] DeviceBuffer<expanded_t<In, Get>> expand_masked(Cuda& exec, const In& in, Size&& size,
                                                              Holds&& holds, Get&& get) {
  using T = expanded_t<In, Get>;
  const auto expansion = make_masked_expansion<kBits>(exec, in, size, holds);
  auto out = make_buffer<T>(exec, expansion.size());
  expand_chunks(exec, expansion, in, cuda_detail::WriteEach<std::decay_t<Get>, T>{get, out.data()});
  return out;
}

}  // namespace rastrum::parallel
