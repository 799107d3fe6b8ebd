// SPDX-License-Identifier: BSD-3-Clause
// The translucent fragments of a block with several samples per pixel, in rows of 8 pixels of one
// sample, for the kernels of packed fragments.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/rules/samples.hpp>
#include <rastrum/transparency/layer_lists.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

namespace rastrum::transparency {

class SampledLayers {
 public:
  explicit SampledLayers(MemoryAccount& memory)
      : keys_(memory), numbers_(memory), places_(memory), sort_keys_(memory) {}

  /// Begins a block. Its fragments may take `bytes`.
  void begin(Isa isa, std::uint64_t bytes) {
    kernel_ = &packed_kernels(isa);
    most_bytes_ = bytes;
    count_ = 0;
  }
  /// A triangle's pixels at a sample, in order of submission unless `deal` has a filter. Pixel i's
  /// colour is colors[number(i) + 1].
  template <class Number>
  void add(std::uint32_t sample, std::uint64_t mask, const std::uint64_t* keys, Number&& number) {
    keys_.grow(count_ + 64, count_);
    numbers_.grow(count_ + 64, count_);
    places_.grow(count_ + 64, count_);
    for (; mask != 0; mask &= mask - 1, ++count_) {
      const int i = std::countr_zero(mask);
      keys_[count_] = keys[i];
      numbers_[count_] = number(i);
      places_[count_] = static_cast<std::uint16_t>(sample * 64 + static_cast<std::uint32_t>(i));
    }
  }
  [[nodiscard]] bool has_room() const {
    return count_ <= kMost && count_ * kFragmentBytes <= most_bytes_;
  }
  /// Puts each pixel's fragments in `order`. With `filter` above 0 a filter looks back over so
  /// many, in the order of `add`. Returns false for too much memory or more than `most_layers`.
  [[nodiscard]] bool deal(int samples, LayerOrder order, std::size_t filter,
                          std::size_t most_layers);

  [[nodiscard]] PackedRow row(std::uint32_t sample, std::size_t y, const Vec4* colors) const {
    const Row& r = rows_[sample * 8 + y];
    return {sort_keys_.data() + r.begin, r.layers, colors};
  }
  [[nodiscard]] std::size_t fragments() const { return count_; }
  /// At one sample of a pixel.
  [[nodiscard]] std::size_t deepest() const { return deepest_; }
  /// Pixels where the filter was too short at any sample.
  [[nodiscard]] std::uint64_t misplaced() const { return misplaced_; }

 private:
  struct Row {
    std::uint32_t begin, layers;
  };
  static constexpr std::size_t kRows = raster::kMaxSamples * 8;
  /// A list has a 16-bit length; a triangle's part of a block is added as a whole.
  static constexpr std::size_t kMost = 65535 - 64;
  /// Growing buffers hold up to twice their content; the colour is the caller's.
  static constexpr std::uint64_t kFragmentBytes = 2 * (8 + 4 + 2) + sizeof(Vec4);

  const PackedKernels* kernel_ = nullptr;
  std::uint64_t most_bytes_ = 0;
  ScratchBuffer<std::uint64_t> keys_;
  ScratchBuffer<std::uint32_t> numbers_;
  ScratchBuffer<std::uint16_t> places_;  ///< 64 · sample + pixel
  ScratchBuffer<std::uint64_t> sort_keys_;
  std::size_t count_ = 0, deepest_ = 0;
  std::uint64_t misplaced_ = 0;
  Row rows_[kRows];
  std::uint16_t most_[kRows];
  alignas(64) std::uint16_t left_[kRows * 8];  ///< a pixel's fragments that have no place yet
};

}  // namespace rastrum::transparency
