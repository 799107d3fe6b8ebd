#include <rastrum/raster/visibility/atomic.hpp>

#include <algorithm>
#include <bit>
#include <utility>

#include <rastrum/raster/setup/make_piece.hpp>

namespace rastrum::raster {
namespace {

class AtomicRegion : public Region {
 public:
  void begin(const RegionContext& context, const SurfaceView& surface, Rect,
             std::size_t chunks) override {
    kernel_ = context.kernel;
    surface_ = surface;
    chunks_ = chunks;
    done_ = false;
  }
  std::optional<Pass> next() override {
    if (std::exchange(done_, true)) return std::nullopt;
    return Pass{0, chunks_};
  }

 protected:
  const Kernels* kernel_ = nullptr;
  SurfaceView surface_;

 private:
  std::size_t chunks_ = 0;
  bool done_ = false;
};

/// Keeps depth bounds beside the keys, where the region is a bin (hierarchical Z).
class OwnedAtomicRegion final : public AtomicRegion {
 public:
  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    AtomicRegion::begin(context, surface, rect, chunks);
    // Who counts overdraw wants to see everything.
    is_bounded_ = context.request->hierarchical_z && context.request->targets.overdraw.empty() &&
                  rect.x0 % kBinSize == 0 && rect.y0 % kBinSize == 0 &&
                  rect.x1 - rect.x0 <= kBinSize && rect.y1 - rect.y0 <= kBinSize;
    if (!is_bounded_) return;
    bounds_.restart();
    std::fill_n(unseen_, kBlocksPerBin, 0U);
    // Blocks outside of the image hide everything.
    for (int i = 0; i < kBlocksPerBin; ++i)
      if (i % kBlocksPerBinRow >= block_columns(rect) || i / kBlocksPerBinRow >= block_rows(rect))
        bounds_.block[i] = 1;
  }

  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    kernel_->maximum(pieces, blocks.data(), blocks.size(), surface_);
    if (is_bounded_) raise_bounds(pieces, blocks);
  }

  DepthBounds* bounds() override { return is_bounded_ ? &bounds_ : nullptr; }
  void find_bounds() override {
    if (!is_bounded_) return;
    for (int i = 0; i < kBlocksPerBin; ++i)
      if (bounds_.block[i] < 1) look(i);
    find_least();
  }

  void collect(Counters& counters) override {
    add_counter(counters, "hidden pieces", std::exchange(bounds_.hidden_pieces, 0));
    add_counter(counters, "hidden blocks", std::exchange(bounds_.hidden_blocks, 0));
  }

  void fragments(std::span<const BinFragment> fragments) override {
    if (surface_.columns == kBlocksPerBinRow) {
      for (const BinFragment& f : fragments)
        surface_.keys[f.pixel] = std::max(surface_.keys[f.pixel], f.key);
      return;
    }
    for (const BinFragment& f : fragments) {
      const auto block = static_cast<int>(f.pixel / 64);
      // The region may be a part of the bin that the fragments count from.
      const int bx0 = surface_.bx0 / kBlocksPerBinRow * kBlocksPerBinRow;
      const int by0 = surface_.by0 / kBlocksPerBinRow * kBlocksPerBinRow;
      std::uint64_t& key = surface_.block(bx0 + block % kBlocksPerBinRow,
                                          by0 + block / kBlocksPerBinRow)[f.pixel % 64];
      key = std::max(key, f.key);
    }
  }

 private:
  /// After so many pieces that cover a block in part its keys are looked at: one such look costs
  /// about as much as drawing a dozen samples, and where a surface of small triangles covers a
  /// pixel once or twice there is nothing to find. (Counting their samples instead cost 3 % of a
  /// frame.)
  static constexpr std::uint32_t kLook = 32;

  void raise_bounds(const Piece* pieces, std::span<const Block> blocks) {
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

  void look(int i) {
    unseen_[i] = 0;
    const std::uint64_t lowest = kernel_->lowest(
        surface_.block(surface_.bx0 + i % kBlocksPerBinRow, surface_.by0 + i / kBlocksPerBinRow));
    bounds_.block[i] = std::max(
        bounds_.block[i], std::bit_cast<float>(static_cast<std::uint32_t>(lowest >> kIdBits)));
  }
  void find_least() {
    bounds_.bin = *std::min_element(bounds_.block, bounds_.block + kBlocksPerBin);
  }

  DepthBounds bounds_;
  std::uint32_t unseen_[kBlocksPerBin] = {};
  bool is_bounded_ = false;
};

class SharedAtomicRegion final : public AtomicRegion {
 public:
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    alignas(64) std::uint64_t keys[64];
    for (const Block& b : blocks) {
      kernel_->keys(pieces[b.piece], b, keys);
      std::uint64_t* const out = surface_.block(b.bx, b.by);
      for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        raise_atomically(out[i], keys[i]);
      }
    }
  }
};

}  // namespace

std::unique_ptr<Region> make_atomic(Sharing sharing, MemoryAccount&) {
  if (sharing == Sharing::owned) return std::make_unique<OwnedAtomicRegion>();
  return std::make_unique<SharedAtomicRegion>();
}

}  // namespace rastrum::raster
