// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/tuple.hpp>

#include <atomic>
#include <cstring>
#include <thread>

#include <papers/axes/fragments.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::family {
namespace {

/// Uses a caller's byte as a lock. It is held only for the maxima of one block, so waiters spin.
/// They yield, because the holder may need their core.
class BlockLock {
 public:
  explicit BlockLock(std::uint8_t& byte) : held_(byte) {
    while (held_.exchange(1, std::memory_order_acquire) != 0)
      while (held_.load(std::memory_order_relaxed) != 0) std::this_thread::yield();
  }
  ~BlockLock() { held_.store(0, std::memory_order_release); }
  BlockLock(const BlockLock&) = delete;
  BlockLock& operator=(const BlockLock&) = delete;

 private:
  std::atomic_ref<std::uint8_t> held_;
};

/// A thread's scratch, zeroed for each use of the region.
struct ScratchOfUse {
  ShaderScratch shader;
  std::uint64_t zeroed_for = 0;
};

template <Sharing kSharing>
class TupleRegion final : public Region {
 public:
  explicit TupleRegion(MemoryAccount& memory) : locks_(memory) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    context_ = context;
    surface_ = surface;
    shading_ = context.plan->colors != raster::FramePlan::Colors::none ? context.request->shading
                                                                       : Shading();
    chunks_ = chunks;
    done_ = false;
    ++use_;
    if constexpr (kSharing == Sharing::shared) {
      pixels_ = {surface, rect};
      locks_.reserve(pixels_.block_count());
      std::memset(locks_.data(), 0, pixels_.block_count());
    }
  }

  std::optional<Pass> next() override {
    if (std::exchange(done_, true)) return std::nullopt;
    return Pass{0, chunks_};
  }

  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    alignas(64) std::uint64_t keys[64] = {};
    BlockColors colors;
    void* const scratch = shader_scratch();
    for (const Block& b : blocks) {
      context_.kernel->keys(pieces[b.piece], b, keys);
      if (shading_) {
        const VisibleBlock visible{keys, b.mask, b.bx * kBlockSize, b.by * kBlockSize, scratch};
        if (shade_block(shading_, *context_.frame, visible, context_.request->isa, colors))
          std::fill_n(colors.a, 64, 1.0F);
      }
      if constexpr (kSharing == Sharing::shared) {
        const BlockLock lock(locks_[pixels_.block(b.bx, b.by)]);
        take_greater(b, keys, colors);
      } else {
        take_greater(b, keys, colors);
      }
    }
    if (shading_) shaded_.fetch_add(count_fragments(blocks), std::memory_order_relaxed);
  }

  void collect(Counters& counters) override {
    add_counter(counters, "fragments shaded", shaded_.exchange(0));
  }

 private:
  void* shader_scratch() {
    if (!shading_) return nullptr;
    ScratchOfUse& scratch = scratch_.local();
    if (std::exchange(scratch.zeroed_for, use_) != use_)
      scratch.shader.begin(scratch_bytes(shading_));
    return scratch.shader.data();
  }

  void take_greater(const Block& b, const std::uint64_t* keys, const BlockColors& colors) {
    std::uint64_t* const out = surface_.block(b.bx, b.by);
    BlockColors* const out_colors = !shading_ ? nullptr : surface_.colors_of(b.bx, b.by);
    for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      if (keys[i] <= out[i]) continue;
      out[i] = keys[i];
      if (out_colors != nullptr)
        out_colors->set(i, {colors.r[i], colors.g[i], colors.b[i], colors.a[i]});
    }
  }

  RegionContext context_;
  Shading shading_;  ///< empty if no colour is wanted
  SurfaceView surface_;
  PixelNumbers pixels_;
  ScratchBuffer<std::uint8_t> locks_;
  parallel::ScratchPool<ScratchOfUse> scratch_;
  std::uint64_t use_ = 0;
  std::size_t chunks_ = 0;
  bool done_ = false;
  std::atomic<std::uint64_t> shaded_ = 0;
};

}  // namespace

std::unique_ptr<Region> make_tuple_region(Sharing sharing, MemoryAccount& memory) {
  if (sharing == Sharing::owned) return std::make_unique<TupleRegion<Sharing::owned>>(memory);
  return std::make_unique<TupleRegion<Sharing::shared>>(memory);
}

}  // namespace rastrum::family
