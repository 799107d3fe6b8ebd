// SPDX-License-Identifier: BSD-3-Clause
// The translucent fragments of a region in the order of submission, in which a triangle's lie side
// by side. They are shaded in that order, 64 at a time, so a triangle is set up for shading once
// and fills vectors. Only their numbers are sorted, by pixel. For moderate depth; deeper regions go
// plane by plane (layers.cpp).
//
// Paper 4 also shades fragments before they are in order ("Phase 3": segments of 256 samples).
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
  int bx, by;  ///< the first block
  int columns, rows;
};

/// A region's translucent fragments of micro triangles, as they were made.
class MicroRecords {
 public:
  explicit MicroRecords(MemoryAccount& memory) : keys_(memory), pixels_(memory) {}

  void restart() { count_ = 0; }
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

  /// `bytes`: the limit of its fragments with their sort_keys; 0: 4 MiB.
  void begin(Isa isa, std::uint64_t bytes);
  /// `sort` looks back over `filter` fragments in pixels with more than filter + 1
  /// (layer_lists.hpp); 0, which `begin` sets: over all. With a filter, `collect` refuses pixels of
  /// more than `most` layers.
  void set_filter(std::size_t filter, std::size_t most) {
    filter_ = filter;
    most_layers_ = most;
  }

  /// Collects the fragments before the keys of `opaque` (may be null). Returns false and collects
  /// nothing if they take too much memory, or do not come in the order of ids.
  bool collect(std::span<const Window> windows, const MicroFragments& micro, const BlockGrid& grid,
               const raster::SurfaceView* opaque);
  /// Nearest first, as far as the filter can.
  void sort();
  /// Pixels of a block where the filter was too short.
  [[nodiscard]] std::uint64_t misplaced(int bx, int by) const;
  /// Above an `opaque_at` of 0 the fragments must be sorted, and hidden layers need not be shaded.
  void shade(const raster::BinContext& context, const raster::Shading& shading, float opaque_at);
  [[nodiscard]] bool any(int bx, int by) const;
  /// Raises the keys of a block to those of the nearest fragments.
  void raise(int bx, int by, std::uint64_t* keys) const;
  /// Blends a block's shaded layers, in the order of `blend`, over `behind`, which may be null.
  void blend(int bx, int by, LayerBlend& blend, const raster::BlockColors* behind,
             raster::BlockColors& out);
  [[nodiscard]] bool has_opaque(int bx, int by) const {
    return opaque_[(by - grid_.by) * grid_.columns + bx - grid_.bx] != nullptr;
  }

  [[nodiscard]] std::size_t fragments() const { return count_; }
  [[nodiscard]] std::size_t deepest() const { return deepest_; }

 private:
  /// Eight pixels: `layers` times 8 sort_keys from sort_keys_[begin] on.
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
  void shade_wanted(const raster::BinContext& context, const raster::Shading& shading);
  /// Shades the nearest layers, then twice as many of unfinished pixels, and so on.
  void shade_by_turns(const raster::BinContext& context, const raster::Shading& shading,
                      float opaque_at);
  /// Leaves out the layers behind each pixel's first `most`.
  void leave_out_behind(std::uint32_t most);
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
  const std::uint64_t* opaque_[kBlocks] = {};  ///< per block of the grid, may be null
  bool sorted_ = false;
  std::size_t filter_ = 0, most_layers_ = 0;

  ScratchBuffer<std::uint64_t> keys_;
  ScratchBuffer<std::uint16_t> pixels_;
  std::size_t count_ = 0;
  ScratchBuffer<Vec4> colors_;  ///< by number + 1
  ScratchBuffer<std::uint64_t> sort_keys_;
  ScratchBuffer<std::uint64_t> first_,
      wanted_;                             ///< bits: the first of a triangle; to be shaded
  ScratchBuffer<std::uint32_t> arrivals_;  ///< of pixels where the filter may fail, largest first
  bool wanted_all_ = false;
  std::size_t deepest_ = 0;
  Row rows_[kRows];
  std::uint16_t most_[kRows];      ///< layers of a row, including hidden ones
  std::uint8_t misplaced_[kRows];  ///< a bit per pixel
  alignas(64) std::uint16_t left_[kPackedPitch * kPackedPitch];  ///< fragments without a place yet
  float through_[kPackedPitch * kPackedPitch];                   ///< in shade_by_turns
  raster::ShadingPoints points_;
  raster::BlockColors plane_;
  alignas(64) std::uint64_t plane_keys_[64];
};

}  // namespace rastrum::transparency
