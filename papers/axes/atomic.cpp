// SPDX-License-Identifier: BSD-3-Clause
#include <papers/axes/atomic.hpp>

#include <bit>

#include <papers/axes/one_pass.hpp>
#include <rastrum/raster/cover/bin_keys.hpp>

namespace rastrum::family {
namespace {

/// A region that one thread owns: the keys of the renderer's own path.
class OwnedAtomicRegion final : public OnePassRegion {
 public:
  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    restart(chunks);
    keys_.begin(*context.kernel, surface, rect, context.hides);
  }
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    keys_.blocks(pieces, blocks);
  }
  void fragments(std::span<const BinFragment> fragments) override { keys_.fragments(fragments); }
  DepthBounds* bounds() override { return keys_.bounds(); }
  void find_bounds() override { keys_.find_bounds(); }
  void collect(Counters& counters) override { keys_.collect(counters); }

 private:
  raster::BinKeys keys_;
};

class SharedAtomicRegion final : public OnePassRegion {
 public:
  void begin(const RegionContext& context, const SurfaceView& surface, Rect,
             std::size_t chunks) override {
    restart(chunks);
    kernel_ = context.kernel;
    surface_ = surface;
  }
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

 private:
  const Kernels* kernel_ = nullptr;
  SurfaceView surface_;
};

}  // namespace

std::unique_ptr<Region> make_atomic(Sharing sharing, MemoryAccount&) {
  if (sharing == Sharing::owned) return std::make_unique<OwnedAtomicRegion>();
  return std::make_unique<SharedAtomicRegion>();
}

}  // namespace rastrum::family
