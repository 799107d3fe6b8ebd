// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/cull/depth_map.hpp>

#include <algorithm>
#include <bit>
#include <limits>

namespace rastrum::raster {

void DepthMap::begin(Rect view) {
  view_ = view;
  columns_ = static_cast<std::size_t>(block_columns(view));
  bin_columns_ = static_cast<std::size_t>((view.x1 - view.x0 + kBinSize - 1) / kBinSize);
  const std::size_t blocks = columns_ * static_cast<std::size_t>(block_rows(view));
  const std::size_t bins =
      bin_columns_ * static_cast<std::size_t>((view.y1 - view.y0 + kBinSize - 1) / kBinSize);
  block_.reserve(blocks);
  bin_.reserve(bins);
  std::fill_n(block_.data(), blocks, 0.0F);
  std::fill_n(bin_.data(), bins, 0.0F);
}

template <class Depth>
void DepthMap::put(Rect bin, const Depth& depth) {
  float all = std::numeric_limits<float>::infinity();
  for (int by = bin.y0 / kBlockSize; by * kBlockSize < bin.y1; ++by)
    for (int bx = bin.x0 / kBlockSize; bx * kBlockSize < bin.x1; ++bx) {
      const float farthest = depth(bx, by);
      all = std::min(all, farthest);
      block_[static_cast<std::size_t>(by - view_.y0 / kBlockSize) * columns_ +
             static_cast<std::size_t>(bx - view_.x0 / kBlockSize)] = farthest;
    }
  const auto is_whole = [](int begin, int end, int first, int last) {
    return (begin - first) % kBinSize == 0 && (end - begin == kBinSize || end == last);
  };
  if (!is_whole(bin.x0, bin.x1, view_.x0, view_.x1) ||
      !is_whole(bin.y0, bin.y1, view_.y0, view_.y1))
    return;
  bin_[static_cast<std::size_t>((bin.y0 - view_.y0) / kBinSize) * bin_columns_ +
       static_cast<std::size_t>((bin.x0 - view_.x0) / kBinSize)] = all;
}

void DepthMap::look(const Kernels& kernel, const SurfaceView& surface, Rect bin) {
  put(bin, [&](int bx, int by) {
    const std::uint64_t* const keys = surface.block(bx, by);
    if ((bx + 1) * kBlockSize <= bin.x1 && (by + 1) * kBlockSize <= bin.y1)
      return depth_of_key(kernel.lowest(keys));
    // Samples outside of the part count as hiding everything.
    std::uint64_t lowest = std::numeric_limits<std::uint64_t>::max();
    for (std::uint64_t m = samples_inside(bin, bx, by); m != 0; m &= m - 1)
      lowest = std::min(lowest, keys[std::countr_zero(m)]);
    return depth_of_key(lowest);
  });
}

void DepthMap::look(const DepthBounds& bounds, Rect bin) {
  put(bin, [&](int bx, int by) {
    return bounds.block[(by - bin.y0 / kBlockSize) * kBlocksPerBinRow + bx - bin.x0 / kBlockSize];
  });
}

void DepthMap::recall(DepthBounds& bounds, Rect bin) const {
  for (int by = bin.y0 / kBlockSize; by * kBlockSize < bin.y1; ++by)
    for (int bx = bin.x0 / kBlockSize; bx * kBlockSize < bin.x1; ++bx)
      bounds.block[(by - bin.y0 / kBlockSize) * kBlocksPerBinRow + bx - bin.x0 / kBlockSize] =
          block_[static_cast<std::size_t>(by - view_.y0 / kBlockSize) * columns_ +
                 static_cast<std::size_t>(bx - view_.x0 / kBlockSize)];
  bounds.bin = bin_[static_cast<std::size_t>((bin.y0 - view_.y0) / kBinSize) * bin_columns_ +
                    static_cast<std::size_t>((bin.x0 - view_.x0) / kBinSize)];
}

bool DepthMap::hides(const Candidate& c) const {
  const int vx0 = view_.x0 / kBlockSize, vy0 = view_.y0 / kBlockSize;
  const int x0 = std::max<int>(c.bx0, vx0), y0 = std::max<int>(c.by0, vy0);
  const int x1 = std::min<int>(c.bx1, vx0 + block_columns(view_));
  const int y1 = std::min<int>(c.by1, vy0 + block_rows(view_));
  if (!(c.highest < std::numeric_limits<float>::infinity()) || c.bx0 == c.bx1) return false;
  constexpr int kPerBin = kBinSize / kBlockSize;
  for (int ty = y0 / kPerBin; ty * kPerBin < y1; ++ty)
    for (int tx = x0 / kPerBin; tx * kPerBin < x1; ++tx) {
      const std::size_t bin = static_cast<std::size_t>(ty - vy0 / kPerBin) * bin_columns_ +
                              static_cast<std::size_t>(tx - vx0 / kPerBin);
      if (c.highest < bin_[bin]) continue;
      for (int by = std::max(y0, ty * kPerBin); by < std::min(y1, (ty + 1) * kPerBin); ++by)
        for (int bx = std::max(x0, tx * kPerBin); bx < std::min(x1, (tx + 1) * kPerBin); ++bx) {
          const float bound = block_[static_cast<std::size_t>(by - vy0) * columns_ +
                                     static_cast<std::size_t>(bx - vx0)];
          if (!(c.highest < bound)) return false;
        }
    }
  return true;
}

}  // namespace rastrum::raster
