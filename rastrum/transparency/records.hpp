// SPDX-License-Identifier: BSD-3-Clause
// The records of a region of layers, sorted first by block (the per-block lists of paper 4, stage
// 3, phase 2), then by depth.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/quadric.hpp>

namespace rastrum::transparency {

/// 8 × 8 pixels anywhere in a region.
struct Window {
  const raster::Piece* piece;
  std::uint64_t mask;   ///< of samples, not empty
  std::uint32_t pixel;  ///< the first: kPackedPitch · row + column
};

/// Calls f(column, row, mask) for the blocks that a window at pixel (x, y) touches.
template <class F>
void for_each_block_of(std::uint64_t mask, std::uint32_t x, std::uint32_t y, F&& f) {
  constexpr auto kSize = static_cast<std::uint32_t>(raster::kBlockSize);
  const std::uint32_t column = x / kSize, row = y / kSize, dx = x % kSize, dy = y % kSize;
  // Samples in the first column and the first row of blocks.
  const std::uint64_t left = (std::uint64_t{0xFF} >> dx) * 0x0101010101010101U;
  const std::uint64_t top = ~std::uint64_t{0} >> (kSize * dy);
  const auto give = [&](std::uint32_t c, std::uint32_t r, std::uint64_t part) {
    if (part != 0) f(c, r, part);
  };
  give(column, row, (mask & left & top) << (kSize * dy + dx));
  if (dx != 0) give(column + 1, row, (mask & ~left & top) >> (kSize - dx) << (kSize * dy));
  if (dy == 0) return;
  const std::uint64_t below = mask >> (kSize * (kSize - dy));
  give(column, row + 1, (below & left) << dx);
  if (dx != 0) give(column + 1, row + 1, (below & ~left) >> (kSize - dx));
}

/// Their number, without a branch that could not be predicted.
inline std::uint64_t blocks_of_window(std::uint64_t mask, std::uint32_t x, std::uint32_t y) {
  constexpr auto kSize = static_cast<std::uint32_t>(raster::kBlockSize);
  const std::uint64_t left = mask & (std::uint64_t{0xFF} >> x % kSize) * 0x0101010101010101U;
  const std::uint64_t right = mask ^ left, top = ~std::uint64_t{0} >> (kSize * (y % kSize));
  return std::uint64_t{(left & top) != 0} + std::uint64_t{(right & top) != 0} +
         std::uint64_t{(left & ~top) != 0} + std::uint64_t{(right & ~top) != 0};
}

struct Record {
  const raster::Piece* piece;
  std::uint64_t mask;   ///< of samples, not empty
  std::uint32_t block;  ///< within the region
};

struct MicroRecord {
  std::uint64_t key;
  std::uint32_t block;
  std::uint32_t pixel;  ///< 8 · row + column
};

template <class T>
class InOrder {
 public:
  explicit InOrder(MemoryAccount& memory) : records_(memory) {}

  void restart() { count_ = 0; }
  void add(const T& record) {
    records_.grow(count_ + 1, count_);
    records_[count_++] = record;
  }
  /// `room` returns space for n more; `added` says how many were written.
  [[nodiscard]] T* room(std::size_t n) {
    records_.grow(count_ + n, count_);
    return records_.data() + count_;
  }
  void added(std::size_t n) { count_ += n; }
  [[nodiscard]] T* end() { return records_.data() + count_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::span<T> in_order() { return {records_.data(), count_}; }
  void remove(std::size_t i) {
    std::copy(records_.data() + i + 1, records_.data() + count_, records_.data() + i);
    --count_;
  }

 protected:
  ScratchBuffer<T> records_;
  std::size_t count_ = 0;
};

/// Also sorts them by block, stably.
template <class T>
class ByBlock : public InOrder<T> {
 public:
  explicit ByBlock(MemoryAccount& memory) : InOrder<T>(memory), sorted_(memory), begin_(memory) {}

  void sort(std::size_t blocks) {
    sorted_.reserve(count_);
    begin_.reserve(blocks + 2);
    std::fill_n(begin_.data(), blocks + 2, 0U);
    for (std::size_t i = 0; i < count_; ++i) ++begin_[records_[i].block + 2];
    for (std::size_t b = 2; b < blocks + 2; ++b) begin_[b] += begin_[b - 1];
    for (std::size_t i = 0; i < count_; ++i) sorted_[begin_[records_[i].block + 1]++] = records_[i];
  }
  [[nodiscard]] std::span<T> of(std::size_t block) {
    return {sorted_.data() + begin_[block], begin_[block + 1] - begin_[block]};
  }

 private:
  using InOrder<T>::records_;
  using InOrder<T>::count_;
  ScratchBuffer<T> sorted_;
  ScratchBuffer<std::uint32_t> begin_;
};

/// Sums over the samples of a mask.
struct MaskSums {
  int count, columns, rows;
};
/// From bits counted by byte; each sum fits into a byte.
[[nodiscard]] RASTRUM_HD constexpr MaskSums sums_of(std::uint64_t mask) {
  const auto by_byte = [](std::uint64_t bits) {
    bits -= bits >> 1 & 0x5555555555555555U;
    bits = (bits & 0x3333333333333333U) + (bits >> 2 & 0x3333333333333333U);
    return (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  };
  const auto weighed = [](std::uint64_t bytes, std::uint64_t weights) {
    return static_cast<int>(bytes * weights >> 56);
  };
  const std::uint64_t rows = by_byte(mask);
  const std::uint64_t columns = 4 * by_byte(mask & 0xF0F0F0F0F0F0F0F0U) +
                                2 * by_byte(mask & 0xCCCCCCCCCCCCCCCCU) +
                                by_byte(mask & 0xAAAAAAAAAAAAAAAAU);
  constexpr std::uint64_t kOne = 0x0101010101010101U;
  // The largest is 224, of all columns or rows.
  return {weighed(rows, kOne), weighed(columns, kOne), weighed(rows, 0x0001020304050607U)};
}

/// At the mean of its samples in block (bx, by).
[[nodiscard]] RASTRUM_HD inline float centroid_depth(const raster::Piece& piece, std::uint64_t mask,
                                                     int bx, int by) {
  if (raster::is_quadric(piece)) {
    // Any guess will do.
    const raster::Quadric& q = raster::quadric_of(piece);
    return (piece.flags & raster::kFacesAway) != 0 ? q.lowest : q.highest;
  }
  const MaskSums sums = sums_of(mask);
  const auto n = static_cast<float>(sums.count);
  const auto x = static_cast<float>(sums.columns);
  const auto y = static_cast<float>(sums.rows);
  constexpr float kPx = 1.0F / raster::kSubpixels;
  const float dx = static_cast<float>(bx * raster::kBlockSize) + 0.5F + x / n -
                   static_cast<float>(piece.x[0]) * kPx;
  const float dy = static_cast<float>(by * raster::kBlockSize) + 0.5F + y / n -
                   static_cast<float>(piece.y[0]) * kPx;
  return piece.z0 + piece.zx * dx + piece.zy * dy;
}

/// The high half of a sort_key, nearest first.
[[nodiscard]] RASTRUM_HD inline std::uint64_t near_first(const raster::Piece& piece,
                                                         std::uint64_t mask, int bx, int by) {
  const float depth = centroid_depth(piece, mask, bx, by);
  return std::uint64_t{~(depth > 0 ? std::bit_cast<std::uint32_t>(depth) : 0)} << 32;
}

}  // namespace rastrum::transparency
