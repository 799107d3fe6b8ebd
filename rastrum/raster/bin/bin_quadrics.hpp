// SPDX-License-Identifier: BSD-3-Clause
// Deferred quadrics of a bin: spheres, cones and tubes of which setup found only the box and the
// nearest depth (kDeferred). The bin's thread takes them from front to back, skips those hidden by
// then, makes the other quadrics and raises its keys by them (decision 0033). So nine tenths of a
// million spheres that lie ten deep are never made, none is kept, and no sample is tested twice.
// The order changes no pixel: keys are maxima.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/bin/groups.hpp>
#include <rastrum/raster/context/frame_context.hpp>
#include <rastrum/raster/cover/bin_keys.hpp>

namespace rastrum::raster {

/// One thread's.
class BinQuadrics {
 public:
  explicit BinQuadrics(MemoryAccount& memory) : sorted_(memory) {}

  /// Raises `keys` by the deferred pieces of `groups` in `bin`, whose rectangle is `rect`. Returns
  /// the samples covered and not hidden. Work O(pieces + samples not hidden); memory 24 bytes a
  /// piece.
  std::uint64_t draw(const BinContext& context, std::span<const Group> groups, std::size_t bin,
                     Rect rect, BinKeys& keys);

 private:
  /// From front to back, nearly.
  std::span<const DeferredInBin> sort(std::span<const Group> groups, std::size_t bin);

  ScratchBuffer<DeferredInBin> sorted_;
};

}  // namespace rastrum::raster
