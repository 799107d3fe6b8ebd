// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/frame/frame_run.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/context/fragment_sink.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::raster {
namespace {

void count_overdraw(const ImageView<std::uint32_t>& overdraw, std::span<const Block> blocks) {
  for (const Block& block : blocks)
    for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
      const int bit = std::countr_zero(m);
      const std::atomic_ref<std::uint32_t> pixel(overdraw(
          block.bx * kBlockSize + bit % kBlockSize, block.by * kBlockSize + bit / kBlockSize));
      pixel.fetch_add(1, std::memory_order_relaxed);
    }
}

template <class MaskOf>
std::span<Block> keep(std::span<Block> blocks, const MaskOf& mask_of) {
  std::size_t kept = 0;
  for (Block block : blocks) {
    block.mask = mask_of(block);
    blocks[kept] = block;
    kept += block.mask != 0;
  }
  return blocks.first(kept);
}

std::uint64_t nearer(const Kernels& kernel, const Piece& piece, const Block& block,
                     const std::uint64_t* there) {
  alignas(64) std::uint64_t own[64];
  kernel.keys(piece, block, own);
  std::uint64_t mask = 0;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    mask |= std::uint64_t{own[i] > there[i]} << i;
  }
  return mask;
}

}  // namespace

std::span<Block> FrameRun::cover(const Piece* pieces, std::span<Block> blocks) const {
  kernel.masks(pieces, blocks.data(), blocks.size());
  return keep(blocks, [&](const Block& b) {
    const bool cut = (b.bx + 1) * kBlockSize > view.x1 || (b.by + 1) * kBlockSize > view.y1;
    return cut ? b.mask & samples_inside(view, b.bx, b.by) : b.mask;
  });
}

void FrameRun::count_fragments(std::span<const Block> blocks) {
  std::uint64_t covered = 0;
  for (const Block& b : blocks) covered += static_cast<std::uint64_t>(parallel::popcount(b.mask));
  fragments.fetch_add(covered, std::memory_order_relaxed);
  if (!plan.hides) count_overdraw(request.targets.overdraw, blocks);
}

void FrameRun::count_fragments(Rect bin, std::span<const BinFragment> of_bin) {
  fragments.fetch_add(of_bin.size(), std::memory_order_relaxed);
  if (plan.hides) return;
  for (const BinFragment& f : of_bin)
    ++request.targets.overdraw(bin.x0 + column_in_bin(f), bin.y0 + row_in_bin(f));
}

std::span<Block> FrameRun::test(const Piece* pieces, std::span<Block> blocks,
                                const SurfaceView* seen) const {
  if (!plan.tests || request.samples > 1) return blocks;
  return keep(blocks, [&](Block b) {
    const Piece& piece = pieces[b.piece];
    if ((piece.flags & kMayDrop) == 0) return b.mask;
    if (seen != nullptr) b.mask = nearer(kernel, piece, b, seen->block(b.bx, b.by));
    return b.mask == 0 ? 0 : request.kept(geometry, piece, b, nullptr);
  });
}

void* FrameRun::shader_scratch() const {
  ShaderOfThread& own = shaders.local();
  if (std::exchange(own.frame, number) != number) own.scratch.begin(scratch_bytes(request.shading));
  return own.scratch.data();
}

std::uint64_t FrameRun::hand_on(const std::uint64_t* keys, int bx, int by) const {
  std::uint64_t mask =
      kernel.covered(keys) & samples_inside({0, 0, request.width, request.height}, bx, by);
  if (mask != 0 && plan.writes == FramePlan::Writes::nearer)
    mask = of_this_pass(request, keys, mask);
  if (mask != 0) request.sink->take(OpaqueKeys{bx, by, keys, mask});
  return mask;
}

SeenBin* FrameRun::seen_bin(const BinSurface& bin) const {
  const Rect& rect = bin.rect;
  const bool is_bin = rect.x1 - rect.x0 <= kBinSize && rect.y1 - rect.y0 <= kBinSize;
  if (plan.colors != FramePlan::Colors::bin || !is_bin ||
      !suits_bin(request.shading, bin, request.isa))
    return nullptr;
  ScratchBuffer<SeenBin>& own = shaders.local().bin;
  if (own.capacity() == 0) {
    own.reserve(1);
    std::memset(static_cast<void*>(own.data()), 0, sizeof(SeenBin));
  }
  own[0].end_row = 0;
  return own.data();
}

void FrameRun::shade(const SurfaceView& from, Rect rect) {
  void* const scratch = shader_scratch();
  const BinSurface bin{from, rect};
  SeenBin* const seen = seen_bin(bin);
  std::uint64_t covered = 0;
  const bool hands_on = plan.translucent != Translucent::blended && request.samples == 1;
  const ImageView<Rgba8>& picture = request.targets.color8;
  const bool streams = streams_colors(plan, rect);
  const int columns = rect.x1 - rect.x0;
  alignas(64) Rgba8 line[kBinSize * kBlockSize];
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kBlockSize) {
    if (const int row = (y0 - rect.y0) / kBlockSize; seen != nullptr && row == seen->end_row)
      see_bin(request.shading, geometry, bin, row, request.isa, *seen);
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kBlockSize) {
      const int bx = x0 / kBlockSize, by = y0 / kBlockSize;
      if (hands_on) {
        const std::uint64_t mask = hand_on(from.block(bx, by), bx, by);
        if (!plan.stores) {
          covered += static_cast<std::uint64_t>(parallel::popcount(mask));
          continue;
        }
      }
      const BlockPixels to = streams ? BlockPixels{line + (x0 - rect.x0), columns} : BlockPixels{};
      covered +=
          static_cast<std::uint64_t>(resolve_block(request, plan, geometry, from.block(bx, by), x0,
                                                   y0, scratch, from.colors_of(bx, by), to, seen));
    }
    if (streams) kernel.stream(line, columns, kBlockSize, &picture(rect.x0, y0), picture.stride);
  }
  if (streams) kernel.end_stream();
  pixels_covered.fetch_add(covered, std::memory_order_relaxed);
}

void FrameRun::shade_nothing(Rect rect) {
  resolve_empty(request, plan, rect);
}

}  // namespace rastrum::raster
