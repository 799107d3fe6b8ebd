// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/cover/bin_keys.hpp>

#include <algorithm>
#include <bit>
#include <utility>

#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::raster {
namespace {

/// A block's depth bound is updated after so many pieces that cover it in part. That costs about as
/// much as drawing a dozen samples, and finds nothing where small triangles cover each pixel once
/// or twice. (Counting samples instead cost 3 % of a frame.)
constexpr std::uint32_t kLook = 32;
/// The same for pieces from front to back, which hide more.
constexpr std::uint32_t kLookInOrder = 2;

/// An empty box in `rect` that can grow.
Rect nothing_of(Rect rect) {
  return {rect.x1, rect.y1, rect.x0, rect.y0};
}

}  // namespace

void BinKeys::begin(const Kernels& kernel, const SurfaceView& surface, Rect rect, bool hides,
                    RowKeys* rows) {
  kernel_ = &kernel;
  surface_ = surface;
  rect_ = rect;
  rows_ = nullptr;
  is_bounded_ = hides && rect.x0 % kBlockSize == 0 && rect.y0 % kBlockSize == 0 &&
                rect.x1 - rect.x0 <= kBinSize && rect.y1 - rect.y0 <= kBinSize;
  if (!is_bounded_) return;
  bounds_.restart();
  std::fill_n(unseen_, kBlocksPerBin, 0U);
  rows_ = rows;
  if (rows_ != nullptr) {
    if (!rows_->touched.empty()) std::fill_n(rows_->keys, RowKeys::kSize, 0);  // left by a stop
    rows_->touched = nothing_of(rect);
    rows_->fragments = 0;
    std::fill_n(rows_->unseen, kBlocksPerBin, 0U);
  }
  // Blocks outside of the image or of the bin's part hide everything.
  for (int i = 0; i < kBlocksPerBin; ++i)
    if (i % kBlocksPerBinRow >= block_columns(rect) || i / kBlocksPerBinRow >= block_rows(rect))
      bounds_.block[i] = 1;
}

void BinKeys::blocks(const Piece* pieces, std::span<const Block> blocks) {
  kernel_->maximum(pieces, blocks.data(), blocks.size(), surface_);
  if (is_bounded_) raise_bounds(pieces, blocks);
}

void BinKeys::fragments(std::span<const BinFragment> fragments) {
  if (surface_.columns == kBlocksPerBinRow && surface_.bx0 % kBlocksPerBinRow == 0 &&
      surface_.by0 % kBlocksPerBinRow == 0) {
    for (const BinFragment& f : fragments)
      surface_.keys[f.pixel] = std::max(surface_.keys[f.pixel], f.key);
    return;
  }
  for (const BinFragment& f : fragments) {
    const auto block = static_cast<int>(f.pixel / 64);
    // Fragments count from the bin's first pixel; the surface may be a part of the bin.
    const int bx0 = surface_.bx0 / kBlocksPerBinRow * kBlocksPerBinRow;
    const int by0 = surface_.by0 / kBlocksPerBinRow * kBlocksPerBinRow;
    std::uint64_t& key = surface_.block(bx0 + block % kBlocksPerBinRow,
                                        by0 + block / kBlocksPerBinRow)[f.pixel % 64];
    key = std::max(key, f.key);
  }
}

void BinKeys::raised(const RaisedKeys& raised) {
  if (!is_bounded_) return;
  bounds_.hidden_blocks += raised.hidden_blocks;
  bool any = false;
  for (std::uint64_t m = raised.blocks; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    if (++unseen_[i] < kLookInOrder) continue;
    look(i);
    any = true;
  }
  if (any) find_least();
}

std::uint64_t BinKeys::rows_raised() {
  if (rows_ == nullptr) return 0;
  std::uint32_t most = 0;
  for (const std::uint32_t n : rows_->unseen) most = std::max(most, n);
  if (most < kLook) return std::exchange(rows_->fragments, 0);
  for (int i = 0; i < kBlocksPerBin; ++i) {
    if (rows_->unseen[i] >= kLook) look(i);
  }
  find_least();
  return std::exchange(rows_->fragments, 0);
}

void BinKeys::take_rows() {
  const Rect box = rows_->touched;
  if (box.empty()) return;
  rows_->touched = nothing_of(rect_);
  const auto block = [](int px) { return px / kBlockSize; };
  for (int by = block(box.y0); by <= block(box.y1 - 1); ++by)
    for (int bx = block(box.x0); bx <= block(box.x1 - 1); ++bx)
      kernel_->take_rows(rows_of(bx, by), surface_.block(bx, by));
}

std::uint64_t* BinKeys::rows_of(int bx, int by) const {
  return rows_->keys + static_cast<std::size_t>(by - surface_.by0) * kBlockSize * RowKeys::kRow +
         static_cast<std::size_t>(bx - surface_.bx0) * kBlockSize;
}

void BinKeys::find_bounds() {
  if (!is_bounded_) return;
  for (int i = 0; i < kBlocksPerBin; ++i)
    if (bounds_.block[i] < 1) look(i);
  find_least();
}

void BinKeys::collect(Counters& counters) {
  add_counter(counters, "hidden pieces", std::exchange(bounds_.hidden_pieces, 0));
  add_counter(counters, "hidden blocks", std::exchange(bounds_.hidden_blocks, 0));
}

void BinKeys::raise_bounds(const Piece* pieces, std::span<const Block> blocks) {
  bool any = false;
  for (const Block& b : blocks) {
    const int i = (b.by - surface_.by0) * kBlocksPerBinRow + (b.bx - surface_.bx0);
    float& bound = bounds_.block[i];
    if (b.mask == ~std::uint64_t{0}) {
      const Piece& piece = pieces[b.piece];
      const int x0 = b.bx * kBlockSize, y0 = b.by * kBlockSize;
      if (has_depth_bounds(piece))
        bound = std::max(bound, lowest_depth(piece, {x0, y0, x0 + kBlockSize, y0 + kBlockSize}));
      any = true;
      continue;
    }
    if (++unseen_[i] < kLook) continue;
    look(i);
    any = true;
  }
  if (any) find_least();
}

void BinKeys::look(int i) {
  unseen_[i] = 0;
  const int bx = surface_.bx0 + i % kBlocksPerBinRow, by = surface_.by0 + i / kBlocksPerBinRow;
  std::uint64_t* const block = surface_.block(bx, by);
  std::uint64_t lowest = 0;
  if (rows_ != nullptr) {
    rows_->unseen[i] = 0;
    lowest = kernel_->take_rows(rows_of(bx, by), block);
  } else {
    lowest = kernel_->lowest(block);
  }
  bounds_.block[i] = std::max(bounds_.block[i],
                              std::bit_cast<float>(static_cast<std::uint32_t>(lowest >> kIdBits)));
}
void BinKeys::find_least() {
  bounds_.bin = *std::min_element(bounds_.block, bounds_.block + kBlocksPerBin);
}

}  // namespace rastrum::raster
