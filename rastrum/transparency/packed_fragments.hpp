// SPDX-License-Identifier: BSD-3-Clause
// The translucent fragments of a region in the order of submission, in which those of a triangle
// lie side by side. They are shaded in that order, 64 at a time whatever their pixels, because a
// triangle is then set up for shading once and interpolated for a few full vectors, not for a part
// of each row that it touches. Only their numbers are sorted, by pixel. This is for regions of
// moderate depth: deeper ones go plane by plane (layers.cpp).
//
// Paper 4 shades fragments before they are in order, too ("Phase 3": segments of 256 samples).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/transparency/blend.hpp>
#include <rastrum/transparency/packed_kernels.hpp>
#include <rastrum/transparency/records.hpp>

namespace rastrum::transparency {

/// At most 8 × 8 blocks, row by row.
struct BlockGrid {
  int bx, by;  ///< of the first block
  int columns, rows;
};

/// The translucent fragments of micro triangles of a region, in the order in which they were made.
class MicroRecords {
 public:
  explicit MicroRecords(MemoryAccount& memory) : keys_(memory), pixels_(memory) {}

  void restart() { count_ = 0; }
  /// As PackedKernels::take has it.
  std::size_t take(const PackedKernels& kernel, std::span<const raster::BinFragment> fragments,
                   std::uint32_t first) {
    reserve(fragments.size());
    const std::size_t n =
        kernel.take(fragments, first, keys_.data() + count_, pixels_.data() + count_);
    count_ += n;
    return n;
  }
  void add(std::uint64_t key, std::uint32_t pixel) {
    reserve(1);
    keys_[count_] = key;
    pixels_[count_++] = static_cast<std::uint16_t>(pixel);
  }
  [[nodiscard]] MicroFragments all() {
    reserve(0);
    std::fill_n(keys_.data() + count_, kPackSlack, std::uint64_t{0});
    return {keys_.data(), pixels_.data(), count_};
  }

 private:
  void reserve(std::size_t more) {
    keys_.grow(count_ + more + kPackSlack, count_);
    pixels_.grow(count_ + more + kPackSlack, count_);
  }

  ScratchBuffer<std::uint64_t> keys_;
  ScratchBuffer<std::uint16_t> pixels_;
  std::size_t count_ = 0;
};

class PackedFragments {
 public:
  explicit PackedFragments(MemoryAccount& memory)
      : keys_(memory),
        pixels_(memory),
        colors_(memory),
        sort_keys_(memory),
        first_(memory),
        wanted_(memory),
        arrivals_(memory) {}

  /// Begins a region. `bytes`: what its fragments may take with their sort_keys, 0 for the default
  /// of 4 MiB.
  void begin(Isa isa, std::uint64_t bytes);
  /// Over how many fragments of a pixel `sort` looks back where more than one more than that lie
  /// (layer_lists.hpp); 0, which is what `begin` says: all. Then pixels have `most` layers, or
  /// `collect` refuses.
  void set_filter(std::size_t filter, std::size_t most) {
    filter_ = filter;
    most_layers_ = most;
  }

  /// Collects the fragments that lie before the keys of `opaque`; null: all. Returns false and
  /// collects nothing if there are too many for the memory, or if they do not come in the order of
  /// ids.
  bool collect(std::span<const Window> windows, const MicroFragments& micro, const BlockGrid& grid,
               const raster::SurfaceView* opaque);
  /// Puts the nearest first, as far as the filter can; they are in the order of submission before.
  void sort();
  /// The pixels of a block where the filter was too short.
  [[nodiscard]] std::uint64_t misplaced(int bx, int by) const;
  /// `opaque_at` as LayerBlend has it: above 0 they must be sorted, and layers behind which it
  /// hides need not be shaded.
  void shade(const raster::BinContext& context, const raster::Shading& shading, float opaque_at);
  /// Whether the block has any of them.
  [[nodiscard]] bool any(int bx, int by) const;
  /// Raises the keys of a block to those of the nearest fragments.
  void raise(int bx, int by, std::uint64_t* keys) const;
  /// Blends the layers of a block, which were shaded and are in the order that `blend` wants,
  /// before `behind`, which may be null: nothing.
  void blend(int bx, int by, LayerBlend& blend, const raster::BlockColors* behind,
             raster::BlockColors& out);
  /// Whether the block has opaque surfaces behind its fragments.
  [[nodiscard]] bool has_opaque(int bx, int by) const {
    return opaque_[(by - grid_.by) * grid_.columns + bx - grid_.bx] != nullptr;
  }

  [[nodiscard]] std::size_t fragments() const { return count_; }
  /// The most fragments that a pixel has.
  [[nodiscard]] std::size_t deepest() const { return deepest_; }

 private:
  /// Eight pixels of a row and their sort_keys, `layers` times 8, from sort_keys_[begin] on.
  struct Row {
    std::uint32_t begin, layers;
  };
  static constexpr int kRows = kPackedPitch * kPackedPitch / 8;

  void count_layers();
  [[nodiscard]] bool leave_out_hidden();
  [[nodiscard]] std::uint64_t fragment_bytes() const;
  [[nodiscard]] bool find_arrivals(std::span<const Window> windows);
  bool deal();
  void deal_sort_keys();
  [[nodiscard]] std::uint8_t filter(const Row& row);
  /// Shades those that `wanted_` has.
  void shade_wanted(const raster::BinContext& context, const raster::Shading& shading);
  /// Shades the nearest layers and then, as far as pixels are not finished, twice as many and so
  /// on.
  void shade_by_turns(const raster::BinContext& context, const raster::Shading& shading,
                      float opaque_at);
  /// Leaves out the layers of each pixel behind the first `most`.
  void leave_out_behind(std::uint32_t most);
  /// A pass of a method that wants to see a layer of all pixels at a time.
  void blend_planes(int bx, int by, LayerBlend& blend);
  [[nodiscard]] const Row& row(int bx, int by, int y) const { return rows_[row_number(bx, by, y)]; }
  [[nodiscard]] int row_number(int bx, int by, int y) const {
    return ((by - grid_.by) * 8 + y) * (kPackedPitch / 8) + bx - grid_.bx;
  }

  const PackedKernels* kernel_ = nullptr;
  const raster::Kernels* raster_kernel_ = nullptr;
  std::uint64_t most_bytes_ = 0;
  BlockGrid grid_{};
  static constexpr int kBlocks =
      kPackedPitch / raster::kBlockSize * (kPackedPitch / raster::kBlockSize);
  const std::uint64_t* opaque_[kBlocks] = {};  ///< by block of the grid; null: none
  bool sorted_ = false;
  std::size_t filter_ = 0, most_layers_ = 0;

  ScratchBuffer<std::uint64_t> keys_;
  ScratchBuffer<std::uint16_t> pixels_;
  std::size_t count_ = 0;
  ScratchBuffer<Vec4> colors_;  ///< by number + 1
  ScratchBuffer<std::uint64_t> sort_keys_;
  ScratchBuffer<std::uint64_t> first_,
      wanted_;                             ///< a bit a fragment: first of a triangle; to be shaded
  ScratchBuffer<std::uint32_t> arrivals_;  ///< of pixels that the filter may fail, largest first
  bool wanted_all_ = false;
  std::size_t deepest_ = 0;
  Row rows_[kRows];
  std::uint16_t most_[kRows];      ///< layers of a row, hidden ones, too
  std::uint8_t misplaced_[kRows];  ///< a bit a pixel
  alignas(64) std::uint16_t left_[kPackedPitch * kPackedPitch];  ///< fragments of a pixel to deal
  float through_[kPackedPitch * kPackedPitch];                   ///< by turns: seen through a pixel
  raster::ShadingPoints points_;
  raster::BlockColors plane_;
  alignas(64) std::uint64_t plane_keys_[64];
};

}  // namespace rastrum::transparency
