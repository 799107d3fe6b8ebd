// SPDX-License-Identifier: BSD-3-Clause
// Paper 3's words on a device: the CPU's listing (words_listing.hpp) on Cuda. Its operators are
// associative to the bit, so the scans may be cut differently from the CPU's.
#include <memory>

#include <papers/axes/cuda_rows.hpp>
#include <papers/paper3/words_listing.hpp>
#include <rastrum/parallel/cuda/by_key.cuh>
#include <rastrum/parallel/cuda/elementwise.cuh>
#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/terrain/cuda/functions.cuh>
#include <rastrum/terrain/cuda/method.cuh>

namespace rastrum::parallel {

template <>
inline constexpr bool kAnyGrouping<family::Pair, family::Occlude> = true;
template <>
inline constexpr bool kAnyGrouping<family::Pixel, family::Fill> = true;

}  // namespace rastrum::parallel

namespace rastrum::family {

std::unique_ptr<terrain::DeviceRenderer> make_cuda_terrain_renderer() {
  static constexpr terrain::MethodOnDevice words{
      draw_by_words<parallel::Cuda, terrain::MapSamples>,
      draw_by_words<parallel::Cuda, terrain::FunctionSamples>};
  return terrain::make_cuda_renderer(&words);
}

}  // namespace rastrum::family
