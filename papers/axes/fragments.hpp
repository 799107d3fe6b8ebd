// SPDX-License-Identifier: BSD-3-Clause
// Shared by the visibility methods: walks the fragments of a block, numbers the pixels of a
// rectangle of blocks, and takes a maximum in memory that a thread owns or shares.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <papers/axes/atomic.hpp>
#include <papers/axes/region.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::family {

/// Raises `value` to at least `candidate`.
template <Sharing kSharing, class T>
void raise(T& value, T candidate) {
  if constexpr (kSharing == Sharing::owned)
    value = std::max(value, candidate);
  else
    raise_atomically(value, candidate);
}

[[nodiscard]] inline std::uint64_t count_fragments(std::span<const Block> blocks) {
  std::uint64_t n = 0;
  for (const Block& b : blocks) n += static_cast<std::uint64_t>(parallel::popcount(b.mask));
  return n;
}

/// For at most this many samples of a block, depths are computed one by one: all 64 at once cost as
/// much as about six.
inline constexpr int kFewSamples = 6;

/// Calls f(sample, key) for the covered samples of a block.
template <class F>
void for_each_fragment(const Kernels& kernel, const Piece& piece, const Block& block, const F& f) {
  if (parallel::popcount(block.mask) <= kFewSamples) {
    for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const float depth = depth_at(piece, block.bx * kBlockSize + i % kBlockSize,
                                   block.by * kBlockSize + i / kBlockSize);
      f(static_cast<std::uint32_t>(i), make_key(depth, piece.low));
    }
    return;
  }
  alignas(64) std::uint64_t keys[64];
  kernel.keys(piece, block, keys);
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    f(static_cast<std::uint32_t>(i), keys[i]);
  }
}

/// Numbers the pixels of a rectangle of blocks without gaps, 64 · block + sample, whatever the
/// stride of the surface that holds their keys.
class PixelNumbers {
 public:
  PixelNumbers() = default;
  PixelNumbers(const SurfaceView& surface, Rect rect)
      : surface_(surface), columns_(block_columns(rect)), blocks_(raster::block_count(rect)) {}

  [[nodiscard]] std::size_t block_count() const { return blocks_; }
  [[nodiscard]] std::size_t pixel_count() const { return blocks_ * 64; }
  [[nodiscard]] std::uint32_t block(int bx, int by) const {
    return static_cast<std::uint32_t>((by - surface_.by0) * columns_ + (bx - surface_.bx0));
  }
  /// The number of a fragment's pixel. Requires that the rectangle begins where the fragment's bin
  /// does.
  [[nodiscard]] std::uint32_t pixel(const BinFragment& f) const {
    if (columns_ == kBlocksPerBinRow) return f.pixel;
    const auto b = static_cast<int>(f.pixel / 64);
    return block(surface_.bx0 + b % kBlocksPerBinRow, surface_.by0 + b / kBlocksPerBinRow) * 64 +
           f.pixel % 64;
  }
  [[nodiscard]] std::uint64_t* keys(std::uint32_t block) const {
    if (columns_ == surface_.columns) return surface_.keys + std::size_t{block} * 64;
    const auto b = static_cast<int>(block);
    return surface_.block(surface_.bx0 + b % columns_, surface_.by0 + b / columns_);
  }

 private:
  SurfaceView surface_;
  int columns_ = 1;
  std::size_t blocks_ = 0;
};

}  // namespace rastrum::family
