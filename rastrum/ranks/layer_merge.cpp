// SPDX-License-Identifier: BSD-3-Clause
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
#include <rastrum/ranks/root_picture.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::ranks {
namespace {

using transparency::SeenPixel;

/// Longer lists are sorted by std::stable_sort, which allocates.
constexpr std::size_t kShortList = 24;

struct Fragment {
  std::uint64_t word;
  const std::byte* color;  ///< Vec4
};

/// Writes the bytes of a SeenBlock.
void put_seen(BlockMask where, const transparency::Seen& seen, std::byte* at) {
  const auto write = [&](const auto& value) {
    std::memcpy(at, &value, sizeof(value));
    at += sizeof(value);
  };
  write(where.mask);
  write(where.block);
  for (std::uint64_t m = where.mask; m != 0; m &= m - 1) write(seen.at(std::countr_zero(m)));
}

/// Blends one block; reused to keep its memory.
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
  /// The pixels with fragments.
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
      transparency::add(sum, one);
    }
    const float share = 1.0F / static_cast<float>(planes_.size());
    for (std::size_t i = 0; i < kPixels; ++i)
      seen_.set(static_cast<int>(i),
                {{sum.r[i] * share, sum.g[i] * share, sum.b[i] * share, sum.a[i] * share}, 0});
    return seen_;
  }

 private:
  void blend_sample(const std::vector<PackedPlane>& planes) {
    find_surfaces(planes);
    deal(planes);
    for (std::size_t i = 0; i < kPixels; ++i) {
      SeenPixel pixel;
      for (const Fragment& f : std::span(list_of(i, planes.size()), counts_[i])) {
        // Equal words are of one part, whose surface is behind its layers.
        if (f.word < surfaces_[i]) break;
        transparency::add_behind(pixel, color_of(f));
        if (pixel.through <= opaque_at_) break;
      }
      seen_.set(static_cast<int>(i), pixel);
    }
  }

  /// Finds the nearest opaque fragments; layers before them are blended over them.
  void find_surfaces(const std::vector<PackedPlane>& planes) {
    behind_ = {};
    surfaces_.fill(0);
    for (const PackedPlane& plane : planes) {
      if (!plane.opaque) continue;
      each_fragment(plane, [&](std::size_t i, const Fragment& f) {
        if (f.word <= surfaces_[i]) return;
        surfaces_[i] = f.word;
        behind_.set(static_cast<int>(i), color_of(f));
      });
    }
  }

  /// Sorts the fragments of all ranks into their pixels' lists, nearest first. Equal words keep
  /// their order: they are of one part, so of one rank, whose planes come in order.
  void deal(const std::vector<PackedPlane>& planes) {
    counts_.fill(0);
    if (fragments_.size() < kPixels * planes.size()) fragments_.resize(kPixels * planes.size());
    const bool is_short = planes.size() <= kShortList;
    for (const PackedPlane& plane : planes) {
      if (plane.opaque) continue;
      each_fragment(plane, [&](std::size_t i, const Fragment& own) {
        Fragment* const list = list_of(i, planes.size());
        std::size_t n = counts_[i]++;
        for (; is_short && n > 0 && list[n - 1].word < own.word; --n) list[n] = list[n - 1];
        list[n] = own;
      });
    }
    for (std::size_t i = 0; i < kPixels && !is_short; ++i)
      std::ranges::stable_sort(std::span(list_of(i, planes.size()), counts_[i]),
                               std::ranges::greater{}, &Fragment::word);
  }

  /// Calls f(pixel, Fragment).
  template <class F>
  static void each_fragment(const PackedPlane& plane, const F& f) {
    std::size_t k = 0;
    for (std::uint64_t m = plane.mask; m != 0; m &= m - 1, ++k)
      f(static_cast<std::size_t>(std::countr_zero(m)),
        Fragment{plane.word(k), plane.colors + k * sizeof(Vec4)});
  }
  /// A pixel's list has at most one fragment of each plane.
  [[nodiscard]] Fragment* list_of(std::size_t pixel, std::size_t planes) {
    return fragments_.data() + pixel * planes;
  }
  [[nodiscard]] static Vec4 color_of(const Fragment& f) {
    Vec4 color;
    std::memcpy(&color, f.color, sizeof(color));
    return color;
  }

  const transparency::BlendKernels* kernel_ = nullptr;
  float opaque_at_ = 0;
  std::vector<std::vector<PackedPlane>> planes_;  ///< of each sample, by rank
  std::vector<Fragment> fragments_;
  std::array<std::size_t, kPixels> counts_{};      ///< of each pixel
  std::array<std::uint64_t, kPixels> surfaces_{};  ///< opaque words; 0: none
  transparency::Seen seen_{};
  raster::BlockColors behind_{};
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
    throw_if_stopped();
    const Group& group = groups[g];
    own.begin(*this);
    for (std::size_t s = group.first; s < group.last; ++s) own.add(sources[s].planes);
    put_seen(group.where, own.blend(), to.data() + group.at);
  };
  parallel::ScratchPool<BlockBlend> pool;
  parallel::for_each_index(
      threads, groups.size(), [&](std::size_t g) { blend_group(g, pool.local()); }, 16);
}

void LayerMerge::blend(const BlockGrid& grid, SharedLayers layers, parallel::Threads* threads,
                       RootPicture* picture) const {
  const auto take_blocks = [&](std::size_t) {
    BlockBlend own;
    for (auto run = layers.take(); run.first != run.last; run = layers.take()) {
      throw_if_stopped();
      for (std::size_t b = run.first; b < run.last; ++b) {
        if (!layers.has(b)) {
          if (picture != nullptr) picture->store_behind(b);
          continue;
        }
        own.begin(*this);
        layers.each_run(b, [&](Reader planes) { own.add(planes); });
        const auto block = static_cast<std::uint32_t>(b);
        const SeenBlock seen{{own.where() & grid.inside(block), block}, own.blend()};
        picture != nullptr ? picture->take_block(seen) : layers.put(seen);
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
