#include <rastrum/ranks/layer_merge.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/ranks/fragments.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::ranks {
namespace {

using transparency::SeenPixel;

/// Lists that are longer are sorted by std::stable_sort, which allocates.
constexpr std::size_t kShortList = 24;

struct Fragment {
  std::uint64_t word;
  const std::byte* color;  ///< Vec4
  bool opaque;
};

/// Nearest first. A part is on one rank, whose list is in order, the opaque surface last; so equal
/// words are.
void sort_list(std::span<Fragment> list) {
  if (list.size() > kShortList) {
    std::ranges::stable_sort(list, std::ranges::greater{}, &Fragment::word);
    return;
  }
  for (std::size_t n = 1; n < list.size(); ++n) {
    const Fragment own = list[n];
    std::size_t k = n;
    for (; k > 0 && list[k - 1].word < own.word; --k) list[k] = list[k - 1];
    list[k] = own;
  }
}

/// As SeenBlock has it.
void put_seen(BlockMask where, const transparency::Seen& seen, std::byte* at) {
  const auto write = [&](const auto& value) {
    std::memcpy(at, &value, sizeof(value));
    at += sizeof(value);
  };
  write(where.mask);
  write(where.block);
  for (std::uint64_t m = where.mask; m != 0; m &= m - 1) write(seen.at(std::countr_zero(m)));
}

/// One block; what it works in is kept.
class BlockBlend {
 public:
  void begin(const LayerMerge& merge) {
    kernel_ = &transparency::blend_kernels(merge.isa);
    opaque_at_ = merge.opaque_at;
    planes_.resize(static_cast<std::size_t>(merge.samples));
    for (auto& of_sample : planes_) of_sample.clear();
  }
  void add(Reader planes) {
    while (!planes.at_end()) {
      const PackedPlane plane = take_plane(planes);
      planes_[static_cast<std::size_t>(plane.sample)].push_back(plane);
    }
  }
  /// Where some are.
  [[nodiscard]] std::uint64_t where() const {
    std::uint64_t mask = 0;
    for (const auto& of_sample : planes_)
      for (const PackedPlane& plane : of_sample) mask |= plane.mask;
    return mask;
  }
  const transparency::Seen& blend() {
    if (planes_.size() == 1) {
      blend_sample(planes_[0]);
      return seen_;
    }
    raster::BlockColors one, sum{};
    for (const auto& of_sample : planes_) {
      blend_sample(of_sample);
      kernel_->finish(seen_, behind_, one);
      for (std::size_t i = 0; i < kPixels; ++i) {
        sum.r[i] += one.r[i];
        sum.g[i] += one.g[i];
        sum.b[i] += one.b[i];
        sum.a[i] += one.a[i];
      }
    }
    const float share = 1.0F / static_cast<float>(planes_.size());
    for (std::size_t i = 0; i < kPixels; ++i)
      seen_.set(static_cast<int>(i),
                {{sum.r[i] * share, sum.g[i] * share, sum.b[i] * share, sum.a[i] * share}, 0});
    return seen_;
  }

 private:
  void blend_sample(const std::vector<PackedPlane>& planes) {
    for (int i = 0; i < static_cast<int>(kPixels); ++i) seen_.set(i, {});
    behind_ = {};
    const std::uint64_t any = collect(planes);
    std::uint64_t finished = 0, left = any;
    for (std::size_t k = 0; left != 0; ++k) {
      std::uint64_t mask = 0;
      for (std::uint64_t m = left; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        const std::uint64_t bit = std::uint64_t{1} << i;
        const auto list = list_of(i);
        if (k == list.size() || list[k].opaque || (finished & bit) != 0) {
          // What is finished may still have a surface behind it, which counts as far as it is seen.
          const auto surface = std::ranges::find(list.subspan(k), true, &Fragment::opaque);
          if (surface != list.subspan(k).end()) behind_.set(i, color_of(*surface));
          left &= ~bit;
          continue;
        }
        plane_.set(i, color_of(list[k]));
        mask |= bit;
      }
      if (mask != 0) finished |= kernel_->behind(plane_, mask, opaque_at_, seen_);
    }
  }

  /// Deals the fragments of all ranks to their pixels and sorts them. Returns where some are.
  std::uint64_t collect(const std::vector<PackedPlane>& planes) {
    std::uint64_t any = 0;
    std::array<std::uint32_t, kPixels> next{};
    for (const PackedPlane& plane : planes) {
      any |= plane.mask;
      for (std::uint64_t m = plane.mask; m != 0; m &= m - 1)
        ++next[static_cast<std::size_t>(std::countr_zero(m))];
    }
    std::uint32_t end = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
      first_[i] = end;
      end += next[i];
      next[i] = first_[i];
    }
    first_[kPixels] = end;
    if (fragments_.size() < end) fragments_.resize(end);
    for (const PackedPlane& plane : planes) {
      std::size_t k = 0;
      for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k) {
        Fragment& f = fragments_[next[static_cast<std::size_t>(std::countr_zero(m))]++];
        std::memcpy(&f.word, plane.words + k * sizeof(f.word), sizeof(f.word));
        f.color = plane.colors + k * sizeof(Vec4);
        f.opaque = plane.opaque;
      }
    }
    for (std::uint64_t m = any; m != 0; m &= m - 1) sort_list(list_of(std::countr_zero(m)));
    return any;
  }

  [[nodiscard]] std::span<Fragment> list_of(int i) {
    const auto at = static_cast<std::size_t>(i);
    return std::span(fragments_).subspan(first_[at], first_[at + 1] - first_[at]);
  }
  [[nodiscard]] static Vec4 color_of(const Fragment& f) {
    Vec4 color;
    std::memcpy(&color, f.color, sizeof(color));
    return color;
  }

  const transparency::BlendKernels* kernel_ = nullptr;
  float opaque_at_ = 0;
  std::vector<std::vector<PackedPlane>> planes_;  ///< of each sample, in the order of ranks
  std::vector<Fragment> fragments_;
  std::array<std::uint32_t, kPixels + 1> first_{};  ///< of each pixel's
  transparency::Seen seen_{};
  raster::BlockColors plane_{}, behind_{};
};

}  // namespace

void LayerMerge::blend(const BlockGrid& grid, const Mail& mail, parallel::Threads* threads,
                       Bytes& to) const {
  struct Source {
    std::uint32_t block;
    Reader planes;
  };
  struct Group {
    std::size_t first, last;  ///< of the sources
    BlockMask where;
    std::size_t at;  ///< in `to`
  };
  std::vector<Source> sources;
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (Reader from = mail.from(r); !from.at_end();) {
      const auto block = from.take<std::uint32_t>();
      const auto size = from.take<std::uint64_t>();
      sources.push_back({block, Reader(from.take_bytes(size))});
    }
  std::ranges::stable_sort(sources, {}, &Source::block);
  std::vector<Group> groups;
  std::size_t end = to.size();
  for (std::size_t i = 0; i < sources.size();) {
    Group group{i, i, {0, sources[i].block}, end};
    for (; group.last < sources.size() && sources[group.last].block == group.where.block;
         ++group.last)
      for (Reader planes = sources[group.last].planes; !planes.at_end();)
        group.where.mask |= take_plane(planes).mask;
    group.where.mask &= grid.inside(group.where.block);
    end += seen_bytes(group.where.mask);
    i = group.last;
    groups.push_back(group);
  }
  to.resize(end);
  const auto blend_group = [&](std::size_t g, BlockBlend& own) {
    parallel::throw_if_stopped();
    const Group& group = groups[g];
    own.begin(*this);
    for (std::size_t s = group.first; s < group.last; ++s) own.add(sources[s].planes);
    put_seen(group.where, own.blend(), to.data() + group.at);
  };
  if (threads == nullptr || threads->concurrency() == 1) {
    BlockBlend own;
    for (std::size_t g = 0; g < groups.size(); ++g) blend_group(g, own);
    return;
  }
  parallel::ScratchPool<BlockBlend> pool;
  parallel::for_each_index(
      *threads, groups.size(), [&](std::size_t g) { blend_group(g, pool.local()); }, 16);
}

void LayerMerge::blend(const BlockGrid& grid, SharedLayers layers,
                       parallel::Threads* threads) const {
  const auto take_blocks = [&](std::size_t) {
    BlockBlend own;
    for (auto run = layers.take(); run.first != run.last; run = layers.take()) {
      parallel::throw_if_stopped();
      for (std::size_t b = run.first; b < run.last; ++b) {
        if (!layers.has(b)) continue;
        own.begin(*this);
        layers.each_list(b, [&](Reader planes) { own.add(planes); });
        const auto block = static_cast<std::uint32_t>(b);
        put_seen({own.where() & grid.inside(block), block}, own.blend(), layers.seen(b).data());
      }
    }
  };
  if (threads == nullptr) return take_blocks(0);
  parallel::for_each_index(*threads, static_cast<std::size_t>(threads->concurrency()), take_blocks,
                           1);
}

std::size_t seen_bytes(std::uint64_t mask) {
  return kMaskBytes + static_cast<std::size_t>(parallel::popcount(mask)) * sizeof(SeenPixel);
}

SeenBlock take_seen(Reader from) {
  SeenBlock block{from.take_mask(), {}};
  for (int i = 0; i < static_cast<int>(kPixels); ++i) block.seen.set(i, {});
  for (std::uint64_t m = block.where.mask; m != 0; m &= m - 1)
    block.seen.set(std::countr_zero(m), from.take<SeenPixel>());
  return block;
}

}  // namespace rastrum::ranks
