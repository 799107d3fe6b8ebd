// Paper 3's words on a device: the listing of the CPU (words_listing.hpp), on Cuda. Its operators
// are associative to the bit, so the scans need not keep the CPU's cut.
#pragma once

#include <rastrum/parallel/cuda/by_key.cuh>
#include <rastrum/parallel/cuda/elementwise.cuh>
#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/terrain/words_listing.hpp>

namespace rastrum::parallel {

template <>
inline constexpr bool kAnyGrouping<terrain::Pair, terrain::Occlude> = true;
template <>
inline constexpr bool kAnyGrouping<terrain::Pixel, terrain::Fill> = true;

}  // namespace rastrum::parallel
