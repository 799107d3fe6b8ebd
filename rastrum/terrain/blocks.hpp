// SPDX-License-Identifier: BSD-3-Clause
// Blocks of columns on threads: their samples leave marks, which then become rows of the picture.
#pragma once

#include <atomic>
#include <bit>
#include <limits>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/terrain/kernels.hpp>
#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {

/// A colour (or a distance's bits) in the first row that a sample shows in. 0 is no mark: no opaque
/// colour and no distance is 0. Between frames all are 0.
class BlockMarks {
 public:
  explicit BlockMarks(MemoryAccount& account) : colors_(account), depths_(account) {}

  void prepare(int height, bool colors, bool depths) {
    const std::size_t n = static_cast<std::size_t>(height) * kBlockColumns;
    const auto grow = [n](ScratchBuffer<std::uint32_t>& marks) {
      if (marks.capacity() >= n) return;
      marks.reserve(n);
      std::fill_n(marks.data(), n, 0U);
    };
    if (colors) grow(colors_);
    if (depths) grow(depths_);
    with_colors_ = colors;
    with_depths_ = depths;
  }

  /// The colours of the cells become opaque.
  void put_cells(const ColumnBlock& block, std::size_t n, const Rgba8* cells) {
    if (!with_colors_) return;
    for (std::size_t i = 0; i < n; ++i)
      colors_[static_cast<std::size_t>(block.mark[i])] =
          std::bit_cast<std::uint32_t>(cells[block.cell[i]]) | kOpaque;
  }
  void put_colors(const ColumnBlock& block, std::size_t n, const Rgba8* colors) {
    if (!with_colors_) return;
    for (std::size_t i = 0; i < n; ++i)
      colors_[static_cast<std::size_t>(block.mark[i])] =
          std::bit_cast<std::uint32_t>(colors[i]) | kOpaque;
  }
  void put_depth(const ColumnBlock& block, std::size_t n, float depth) {
    if (!with_depths_) return;
    for (std::size_t i = 0; i < n; ++i)
      depths_[static_cast<std::size_t>(block.mark[i])] = std::bit_cast<std::uint32_t>(depth);
  }

  /// Writes columns [first, first + n) and clears the marks.
  void resolve(const Kernels& kernels, std::size_t first, std::size_t n, int height, Rgba8 sky,
               const TerrainTargets& targets) {
    const auto write = [&](ScratchBuffer<std::uint32_t>& marks, const auto& view,
                           std::uint32_t empty) {
      alignas(64) std::uint32_t above[kBlockColumns];
      std::fill_n(above, kBlockColumns, empty);
      auto* out = reinterpret_cast<std::uint32_t*>(view.data + first);
      const bool aligned = reinterpret_cast<std::uintptr_t>(out) % 64 == 0 && view.stride % 16 == 0;
      kernels.fill(marks.data(), 0, height, n, above, out, view.stride, aligned);
    };
    if (with_colors_) write(colors_, targets.color8, std::bit_cast<std::uint32_t>(sky));
    if (with_depths_)
      write(depths_, targets.depth,
            std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()));
  }

 private:
  static constexpr std::uint32_t kOpaque = std::bit_cast<std::uint32_t>(Rgba8{0, 0, 0, 255});
  bool with_colors_ = false, with_depths_ = false;
  ScratchBuffer<std::uint32_t> colors_, depths_;
};

struct BlockPool {
  explicit BlockPool(MemoryAccount& account) : marks([&account] { return BlockMarks(account); }) {}
  parallel::ScratchPool<BlockMarks> marks;
};

/// The first block is shorter if the rows of all others can then begin on a cache line and be
/// streamed: a quarter less time at 1080p and half at 2160p (least of alternating runs, on a busy
/// machine).
struct Blocks {
  std::size_t columns, lead, count;

  Blocks(int width, const TerrainTargets& targets) : columns(static_cast<std::size_t>(width)) {
    const void* begin = targets.color8.data;
    if (begin == nullptr) begin = targets.depth.data;
    const std::size_t beyond = reinterpret_cast<std::uintptr_t>(begin) % 64 / sizeof(Rgba8);
    lead = std::min(columns, (16 - beyond) % 16);
    count = (lead > 0 ? 1 : 0) + (columns - lead + kBlockColumns - 1) / kBlockColumns;
  }
  [[nodiscard]] std::size_t first(std::size_t block) const {
    if (lead == 0) return block * kBlockColumns;
    return block == 0 ? 0 : lead + (block - 1) * kBlockColumns;
  }
  [[nodiscard]] std::size_t size(std::size_t block) const {
    if (lead > 0 && block == 0) return lead;
    return std::min(kBlockColumns, columns - first(block));
  }
};

/// Calls walk(kernels, block, marks) for each block, then writes its columns.
template <class Walk>
Counts draw_blocks(parallel::Threads& exec, Isa isa, BlockPool& pool, Rgba8 sky,
                   const TerrainTargets& targets, const Blocks& blocks, int height, Walk&& walk) {
  const Kernels& table = kernels(isa);
  std::atomic<std::uint64_t> samples = 0, visible = 0;
  parallel::for_each_with_scratch(
      exec, blocks.count, pool.marks, [&](std::size_t b, BlockMarks& marks) {
        marks.prepare(height, !targets.color8.empty(), !targets.depth.empty());
        const Counts counts = walk(table, b, marks);
        marks.resolve(table, blocks.first(b), blocks.size(b), height, sky, targets);
        samples += counts.samples;
        visible += counts.visible;
      });
  return {samples, visible};
}

}  // namespace rastrum::terrain
