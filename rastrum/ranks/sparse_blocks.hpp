// SPDX-License-Identifier: BSD-3-Clause
// 64 numbers for each 8 × 8 block that has any, so that a rank that draws a corner of the picture
// neither clears nor visits the rest.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/ranks/blocks.hpp>

namespace rastrum::ranks {

class SparseBlocks {
 public:
  explicit SparseBlocks(std::size_t blocks = 0) : masks_(blocks), values_(blocks) {}
  /// The pixels of an image that are not 0.
  SparseBlocks(const BlockGrid& grid, ImageView<const std::uint64_t> image)
      : SparseBlocks(grid.count()) {
    std::array<std::uint64_t, kPixels> values{};
    for (std::size_t b = 0; b < masks_.size(); ++b) {
      std::uint64_t mask = 0;
      grid.each_pixel({~std::uint64_t{0}, static_cast<std::uint32_t>(b)}, [&](int i, int x, int y) {
        values[static_cast<std::size_t>(i)] = image(x, y);
        mask |= std::uint64_t{image(x, y) != 0} << i;
      });
      if (mask != 0) set(b, values.data(), mask);
    }
  }

  [[nodiscard]] std::size_t count() const { return masks_.size(); }
  [[nodiscard]] std::uint64_t mask(std::size_t block) const { return masks_[block]; }
  /// The block's 64 numbers, 0 outside its mask. The mask must not be empty.
  [[nodiscard]] const std::uint64_t* of(std::size_t block) const { return values_[block]->data(); }
  /// A pixel's number; 0 for none.
  [[nodiscard]] std::uint64_t at(std::size_t block, int i) const {
    return masks_[block] == 0 ? 0 : of(block)[i];
  }
  /// Thread-safe for distinct blocks.
  void set(std::size_t block, const std::uint64_t* values, std::uint64_t mask) {
    auto& own = values_[block];
    if (!own) own = std::make_unique<std::array<std::uint64_t, kPixels>>();
    masks_[block] = mask;
    for (std::size_t i = 0; i < kPixels; ++i) (*own)[i] = (mask >> i & 1) != 0 ? values[i] : 0;
  }
  /// Keeps the greater numbers. `values`: 8 bytes per pixel of the mask.
  void raise(BlockMask b, std::span<const std::byte> values) {
    auto& own = values_[b.block];
    if (!own) own = std::make_unique<std::array<std::uint64_t, kPixels>>();
    masks_[b.block] |= b.mask;
    std::size_t at = 0;
    for (std::uint64_t m = b.mask; m != 0; m &= m - 1, at += sizeof(std::uint64_t)) {
      std::uint64_t value = 0;
      std::memcpy(&value, values.data() + at, sizeof(value));
      std::uint64_t& held = (*own)[static_cast<std::size_t>(std::countr_zero(m))];
      held = std::max(held, value);
    }
  }
  [[nodiscard]] bool any() const {
    return std::ranges::any_of(masks_, [](std::uint64_t m) { return m != 0; });
  }
  [[nodiscard]] std::uint64_t pixels() const {
    std::uint64_t n = 0;
    for (const std::uint64_t m : masks_) n += static_cast<unsigned>(std::popcount(m));
    return n;
  }

 private:
  std::vector<std::uint64_t> masks_;
  std::vector<std::unique_ptr<std::array<std::uint64_t, kPixels>>> values_;
};

}  // namespace rastrum::ranks
