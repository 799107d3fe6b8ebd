// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper1/search.hpp>

#include <atomic>

#include <papers/axes/fragments.hpp>

namespace rastrum::family {
namespace {

/// Is 0 both for a surface at depth 0 and for no surface. The second pass writes whole keys and so
/// tells them apart.
std::uint32_t depth_of_key(std::uint64_t key) {
  return static_cast<std::uint32_t>(key >> kIdBits);
}

template <Sharing kSharing>
class SearchRegion final : public Region {
 public:
  explicit SearchRegion(MemoryAccount& memory) : depth_(memory) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    kernel_ = context.kernel;
    pixels_ = {surface, rect};
    chunks_ = chunks;
    step_ = Step::begun;
    depth_.reserve(pixels_.pixel_count());
    const auto load = [&](std::size_t block) {
      const std::uint64_t* const keys = pixels_.keys(static_cast<std::uint32_t>(block));
      std::transform(keys, keys + 64, depth_.data() + block * 64, depth_of_key);
    };
    if (context.exec != nullptr)
      parallel::for_each_index(*context.exec, pixels_.block_count(), load, 64);
    else
      for (std::size_t b = 0; b < pixels_.block_count(); ++b) load(b);
  }

  std::optional<Pass> next() override {
    if (step_ == Step::searching) return std::nullopt;
    step_ = step_ == Step::begun ? Step::maximum : Step::searching;
    return Pass{0, chunks_};
  }

  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    std::uint64_t matches = 0;
    for (const Block& b : blocks) {
      const std::uint32_t block = pixels_.block(b.bx, b.by);
      std::uint32_t* const depth = depth_.data() + std::size_t{block} * 64;
      if (step_ == Step::maximum) {
        for_each_fragment(*kernel_, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
          raise<kSharing>(depth[i], depth_of_key(key));
        });
      } else {
        std::uint64_t* const keys = pixels_.keys(block);
        for_each_fragment(*kernel_, pieces[b.piece], b, [&](std::uint32_t i, std::uint64_t key) {
          if (depth[i] != depth_of_key(key)) return;
          raise<kSharing>(keys[i], key);
          ++matches;
        });
      }
    }
    count(count_fragments(blocks), matches);
  }

  void fragments(std::span<const BinFragment> fragments) override {
    std::uint64_t matches = 0;
    for (const BinFragment& f : fragments) {
      const std::uint32_t pixel = pixels_.pixel(f);
      if (step_ == Step::maximum) {
        raise<kSharing>(depth_[pixel], depth_of_key(f.key));
      } else if (depth_[pixel] == depth_of_key(f.key)) {
        raise<kSharing>(pixels_.keys(pixel / 64)[pixel % 64], f.key);
        ++matches;
      }
    }
    count(fragments.size(), matches);
  }

  void collect(Counters& counters) override {
    add_counter(counters, "fragments compared", compared_.exchange(0));
    add_counter(counters, "depth matches", matches_.exchange(0));
  }

 private:
  enum class Step { begun, maximum, searching };

  void count(std::uint64_t fragments, std::uint64_t matches) {
    if (step_ != Step::searching) return;
    compared_.fetch_add(fragments, std::memory_order_relaxed);
    matches_.fetch_add(matches, std::memory_order_relaxed);
  }

  const Kernels* kernel_ = nullptr;
  PixelNumbers pixels_;
  ScratchBuffer<std::uint32_t> depth_;
  std::size_t chunks_ = 0;
  Step step_ = Step::begun;
  std::atomic<std::uint64_t> compared_ = 0, matches_ = 0;
};

}  // namespace

std::unique_ptr<Region> make_search(Sharing sharing, MemoryAccount& memory) {
  if (sharing == Sharing::owned) return std::make_unique<SearchRegion<Sharing::owned>>(memory);
  return std::make_unique<SearchRegion<Sharing::shared>>(memory);
}

}  // namespace rastrum::family
