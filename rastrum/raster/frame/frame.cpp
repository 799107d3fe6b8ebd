#include <rastrum/raster/frame/frame.hpp>

#include <bit>
#include <utility>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/stop.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

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

void count_overdraw(const ImageView<std::uint32_t>& overdraw, Rect bin,
                    std::span<const BinFragment> fragments) {
  for (const BinFragment& f : fragments)
    ++overdraw(bin.x0 + column_in_bin(f), bin.y0 + row_in_bin(f));
}

/// Keeps the blocks that `mask_of` leaves samples, in order.
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

}  // namespace

void Emitter::flush() {
  if (count_ == 0) return;
  parallel::throw_if_stopped();  // one tile or chunk may have most of the scene
  std::span<Block> blocks(worker_.blocks, count_);
  count_ = 0;
  if (to_cover_) {
    frame_.kernel.masks(pieces_, blocks.data(), blocks.size());
    const Rect view = frame_.view;
    blocks = keep(blocks, [&](const Block& b) {
      const bool cut = (b.bx + 1) * kBlockSize > view.x1 || (b.by + 1) * kBlockSize > view.y1;
      return cut ? b.mask & samples_inside(view, b.bx, b.by) : b.mask;
    });
    to_cover_ = false;
  }
  if (first_pass_) {
    std::uint64_t covered = 0;
    for (const Block& b : blocks) covered += static_cast<std::uint64_t>(parallel::popcount(b.mask));
    frame_.fragments.fetch_add(covered, std::memory_order_relaxed);
    if (!frame_.request.targets.overdraw.empty())
      count_overdraw(frame_.request.targets.overdraw, blocks);
  }
  // With several samples a pixel a triangle is tested once a pixel, by who resolves them.
  if (frame_.request.has_tests() && frame_.request.samples == 1) {
    blocks = keep(blocks, [&](const Block& b) {
      const Piece& piece = pieces_[b.piece];
      return (piece.flags & kMayDrop) == 0
                 ? b.mask
                 : frame_.request.kept(frame_.geometry, piece, b, nullptr);
    });
  }
  if (!blocks.empty()) region_.blocks(chunk_, pieces_, blocks);
}

void Emitter::fragments(Rect bin, std::span<const BinFragment> fragments) {
  if (first_pass_) {
    frame_.fragments.fetch_add(fragments.size(), std::memory_order_relaxed);
    if (!frame_.request.targets.overdraw.empty())
      count_overdraw(frame_.request.targets.overdraw, bin, fragments);
  }
  region_.fragments(fragments);
}

void* Frame::shader_scratch(Worker& worker) const {
  if (std::exchange(worker.shader_of, number) != number)
    worker.shader.begin(request.shading.scratch_bytes());
  return worker.shader.data();
}

void Frame::shade(const SurfaceView& from, Rect rect, Worker& worker) {
  void* const shader = shader_scratch(worker);
  const Backdrop backdrop = backdrop_of(request);
  std::uint64_t covered = 0;
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kBlockSize)
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kBlockSize) {
      const int bx = x0 / kBlockSize, by = y0 / kBlockSize;
      covered += static_cast<std::uint64_t>(resolve_block(
          request, geometry, backdrop, from.block(bx, by), x0, y0, shader, from.colors_of(bx, by)));
    }
  pixels_covered.fetch_add(covered, std::memory_order_relaxed);
}

void Frame::shade_nothing(Rect rect) {
  resolve_empty(request, rect);
}

}  // namespace rastrum::raster
