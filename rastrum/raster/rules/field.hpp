// SPDX-License-Identifier: BSD-3-Clause
// Rasterizes signed scalar fields: circles, quadrics, distance fields (paper 1, section 4.4).
// Expands a field to the 8 × 8 blocks of its box and masks them to the samples where it is not
// negative. A triangle is the field of its smallest edge function. There is no setup and no piece:
// the caller's function decides at pixel centres.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/parallel/expand_masked.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::raster {

struct FieldPixel {
  std::uint32_t field;
  std::uint16_t x, y;
};

/// The samples of the blocks that a box touches, numbered, 64 a block.
class BlockSamples {
 public:
  RASTRUM_HD BlockSamples(Rect box, Rect view)
      : box_{box.x0 > view.x0 ? box.x0 : view.x0, box.y0 > view.y0 ? box.y0 : view.y0,
             box.x1 < view.x1 ? box.x1 : view.x1, box.y1 < view.y1 ? box.y1 : view.y1} {
    if (box_.empty()) return;
    bx_ = box_.x0 / kBlockSize;
    by_ = box_.y0 / kBlockSize;
    columns_ = (box_.x1 - 1) / kBlockSize - bx_ + 1;
    rows_ = (box_.y1 - 1) / kBlockSize - by_ + 1;
  }
  [[nodiscard]] RASTRUM_HD std::size_t size() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) * 64;
  }
  [[nodiscard]] RASTRUM_HD int x(std::size_t j) const {
    const auto block = j / 64 % static_cast<std::size_t>(columns_);
    return (bx_ + static_cast<int>(block)) * kBlockSize + static_cast<int>(j % kBlockSize);
  }
  [[nodiscard]] RASTRUM_HD int y(std::size_t j) const {
    const auto block = j / 64 / static_cast<std::size_t>(columns_);
    return (by_ + static_cast<int>(block)) * kBlockSize + static_cast<int>(j % 64 / kBlockSize);
  }
  [[nodiscard]] RASTRUM_HD bool inside(std::size_t j) const {
    const int px = x(j), py = y(j);
    return px >= box_.x0 && px < box_.x1 && py >= box_.y0 && py < box_.y1;
  }

 private:
  Rect box_;
  int bx_ = 0, by_ = 0, columns_ = 0, rows_ = 0;
};

/// The pixels of `view` covered by the fields, field by field: inside of box(field) → Rect, with
/// value(field, x, y) ≥ 0 at (x + ½, y + ½). A NaN is outside. `view`: non-negative, at most 65,536
/// px each way; fewer than 2³² fields. Several threads call both functions. Work O(fields + samples
/// of the boxes' blocks), span O(log fields + kBlock). Memory: the result, 8 bytes a field and 8 a
/// block.
template <class Exec, parallel::Readable Fields, class Box, class Value>
[[nodiscard]] parallel::Buffer<FieldPixel> field_pixels(Exec& exec, const Fields& fields, Rect view,
                                                        const Box& box, const Value& value) {
  const auto samples = [&](std::uint32_t i) { return BlockSamples(box(fields[i]), view); };
  return parallel::expand_masked<64>(
      exec, parallel::counting<std::uint32_t>(std::size(fields)),
      [&](std::uint32_t i) { return samples(i).size(); },
      [&](std::uint32_t i, std::size_t j) {
        const BlockSamples s = samples(i);
        return s.inside(j) && value(fields[i], static_cast<float>(s.x(j)) + 0.5F,
                                    static_cast<float>(s.y(j)) + 0.5F) >= 0;
      },
      [&](std::uint32_t i, std::size_t j) {
        const BlockSamples s = samples(i);
        return FieldPixel{i, static_cast<std::uint16_t>(s.x(j)),
                          static_cast<std::uint16_t>(s.y(j))};
      });
}

}  // namespace rastrum::raster
