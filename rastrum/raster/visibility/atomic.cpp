#include <rastrum/raster/visibility/atomic.hpp>

#include <algorithm>
#include <bit>

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

class OwnedAtomicRegion final : public AtomicRegion {
 public:
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    kernel_->maximum(pieces, blocks.data(), blocks.size(), surface_);
  }

  void fragments(std::span<const BinFragment> fragments) override {
    if (surface_.columns == kBlocksPerBinRow) {
      for (const BinFragment& f : fragments)
        surface_.words[f.pixel] = std::max(surface_.words[f.pixel], f.word);
      return;
    }
    for (const BinFragment& f : fragments) {
      const auto block = static_cast<int>(f.pixel / 64);
      std::uint64_t& word = surface_.block(surface_.bx0 + block % kBlocksPerBinRow,
                                           surface_.by0 + block / kBlocksPerBinRow)[f.pixel % 64];
      word = std::max(word, f.word);
    }
  }
};

class SharedAtomicRegion final : public AtomicRegion {
 public:
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    alignas(64) std::uint64_t words[64];
    for (const Block& b : blocks) {
      kernel_->words(pieces[b.piece], b, words);
      std::uint64_t* const out = surface_.block(b.bx, b.by);
      for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        raise_atomically(out[i], words[i]);
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
