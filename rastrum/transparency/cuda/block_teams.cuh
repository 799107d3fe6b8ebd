// A block of 8 × 8 pixels by a team: paper 4, stage 3, phases 2 and 3, for blocks whose records fit
// into shared memory.
//
// The records (piece, mask) are sorted there by the depth at their samples' centroid, and the
// samples of the sorted records are numbered by a prefix sum. Segments of them are shaded, a sample
// a thread whatever its pixel; a bit for each then tells its pixel, whose thread takes the samples
// of the segment in order, through the depth filter. Pixels that it could not order are blended
// again, exactly, by their thread alone.
//
// Where it deviates: a team owns a block, not a bin of 16 of them, because records carry their
// masks from binning and need no second division; so a team is small, many are in flight, and low
// and high density are two sizes of one kernel. Sorting goes through shared memory, or within warps
// by shuffles, as the paper's does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/parallel/cuda/exec.cuh>
#include <rastrum/parallel/cuda/team.cuh>
#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/reduce_by_index.hpp>
#include <rastrum/transparency/cuda/fragments.cuh>

namespace rastrum::transparency::cuda {

/// The records of blocks that lie side by side: those of block b are [first[b], first[b + 1]) less
/// `skipped`.
struct RecordView {
  const raster::Block* records;
  std::span<const std::uint64_t> first;
  std::uint64_t skipped;

  RASTRUM_HD std::span<const raster::Block> of(std::size_t b) const {
    return {records + (first[b] - skipped), static_cast<std::size_t>(first[b + 1] - first[b])};
  }
};

/// Counters of a frame, on the device.
enum Counter : std::size_t { kFragments, kDeepest, kRepaired, kCounters };

/// Adds what a team or a thread has counted.
RASTRUM_HD inline void count_layers(std::uint64_t* counters, std::uint64_t fragments,
                                    std::uint64_t deepest, std::uint64_t repaired) {
  if (fragments == 0) return;
  parallel::atomic_add(counters[kFragments], fragments);
  parallel::atomic_maximum(counters[kDeepest], deepest);
  if (repaired != 0) parallel::atomic_add(counters[kRepaired], repaired);
}

/// Low density: two warps, a thread a pixel, in 9 KiB. High: what 48 KiB hold, with more threads to
/// shade and to sort. As nvcc 13 compiles them for sm_90, without spills, a thread takes 76
/// registers with a trivial shader, so that 13 teams of low density fit a multiprocessor, and 167
/// with the lit shaders, 6 teams. Neither was measured on a GPU.
template <bool sort_by_warps>
struct LowDensity {
  static constexpr std::size_t kRecords = 256, kSegment = 128;
  static constexpr int kThreads = 64;
  static constexpr bool kSortByWarps = sort_by_warps;
};
template <bool sort_by_warps>
struct HighDensity {
  static constexpr std::size_t kRecords = 2048, kSegment = 256;
  static constexpr int kThreads = 256;
  static constexpr bool kSortByWarps = sort_by_warps;
};
/// How records are sorted where nobody asks: not by shuffles, until a GPU has measured both.
inline constexpr bool kSortByWarps = false;

template <class Density>
struct BlockScratch {
  static constexpr std::size_t kSegmentWords = Density::kSegment / 64;

  std::uint64_t keys[Density::kRecords];
  std::uint16_t order[Density::kRecords];      ///< of the records, as sorted
  std::uint32_t first[Density::kRecords + 1];  ///< sample of each sorted record
  std::uint64_t words[Density::kSegment];      ///< and colours of its samples
  float r[Density::kSegment], g[Density::kSegment], b[Density::kSegment], a[Density::kSegment];
  std::uint64_t takers[64][kSegmentWords];  ///< which samples of the segment a pixel has
  std::uint64_t opaque[64], limit[64];
  std::uint32_t layers[64], repaired;
};

template <class Density, class Pixel, class Frame>
struct BlendBlock {
  using Scratch = BlockScratch<Density>;
  static_assert(sizeof(Scratch) <= 48 * 1024);
  static constexpr bool kWantsWarps = Density::kSortByWarps;
  static constexpr std::size_t kMembers =
      parallel::cuda_system::kTeamMembers<Density::kThreads, kWantsWarps>;
  /// Pixels that a member keeps to itself: one, where there are threads enough.
  static constexpr std::size_t kShare = (64 + kMembers - 1) / kMembers;

  Frame frame;
  RecordView records;
  std::span<const std::size_t> blocks;
  std::uint64_t* counters;

  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, Scratch& s, const Team& team) const {
    const std::size_t b = blocks[i];
    const std::span<const raster::Block> mine = records.of(b);
    prepare(b, mine, s, team);
    const std::size_t total = s.first[mine.size()];
    Pixel pixels[kShare];
    each_own(team,
             [&](std::size_t k, std::size_t p) { pixels[k].begin(frame.colors[b * 64 + p]); });
    for (std::size_t begin = 0; begin < total; begin += Density::kSegment) {
      const std::size_t left = total - begin;
      shade(b, mine, begin, left < Density::kSegment ? left : Density::kSegment, s, team);
      team.sync();
      each_own(team, [&](std::size_t k, std::size_t p) { take(pixels[k], p, s); });
      team.sync();
    }
    each_own(team, [&](std::size_t k, std::size_t p) {
      if (s.layers[p] == 0) return;
      finish(pixels[k], b, p, mine, s);
    });
    team.sync();
    if (team.rank() != 0) return;
    std::uint64_t fragments = 0, deepest = 0;
    for (std::size_t p = 0; p < 64; ++p) {
      fragments += s.layers[p];
      if (s.layers[p] > deepest) deepest = s.layers[p];
    }
    count_layers(counters, fragments, deepest, s.repaired);
  }

 private:
  /// f(k, p) for the k-th pixel p of a member. Unrolled, a pixel stays in registers.
  template <class Team, class F>
  RASTRUM_HD static void each_own(const Team& team, const F& f) {
    for (std::size_t k = 0; k < kShare; ++k) {
      const std::size_t p = team.rank() + k * team.size();
      if (p < 64) f(k, p);
    }
  }

  template <class Team>
  RASTRUM_HD void prepare(std::size_t b, std::span<const raster::Block> mine, Scratch& s,
                          const Team& team) const {
    for (std::size_t k = team.rank(); k < mine.size(); k += team.size()) {
      s.keys[k] = Pixel::record_key(frame.pieces[mine[k].piece], mine[k]);
      s.order[k] = static_cast<std::uint16_t>(k);
    }
    each_own(team, [&](std::size_t, std::size_t p) {
      s.opaque[p] = s.limit[p] = frame.words[b * 64 + p];
      s.layers[p] = 0;
      for (std::uint64_t& bits : s.takers[p]) bits = 0;
    });
    if (team.rank() == 0) s.repaired = 0;
    sort(s, mine.size(), team);
    for (std::size_t k = team.rank(); k < mine.size(); k += team.size())
      s.first[k] = static_cast<std::uint32_t>(parallel::popcount(mine[s.order[k]].mask));
    parallel::team_prefix_sums(s.first, mine.size(), team);
  }

  template <class Team>
  RASTRUM_HD static void sort(Scratch& s, std::size_t n, const Team& team) {
    if (n <= Pixel::kAnyOrder)
      team.sync();
    else if constexpr (Density::kSortByWarps)
      parallel::team_sort_by_warps(s.keys, s.order, n, team);
    else
      parallel::team_sort(s.keys, s.order, n, team);
  }

  /// Samples [begin, begin + n) of the sorted records.
  template <class Team>
  RASTRUM_HD void shade(std::size_t b, std::span<const raster::Block> mine, std::size_t begin,
                        std::size_t n, Scratch& s, const Team& team) const {
    const std::span<const std::uint32_t> first(s.first, mine.size());
    for (std::size_t i = team.rank(); i < n; i += team.size()) {
      const std::size_t r = parallel::expand_detail::last_at_most(first, begin + i);
      const raster::Block& record = mine[s.order[r]];
      const auto p = static_cast<std::size_t>(
          parallel::select_bit<64>(record.mask, static_cast<int>(begin + i - first[r])));
      const int x = frame.x_of(b, p), y = frame.y_of(b, p);
      const std::uint64_t word = frame.word(frame.pieces[record.piece], x, y);
      if (word <= s.opaque[p]) continue;
      parallel::atomic_add(s.layers[p], 1U);
      if (word <= s.limit[p]) continue;
      const Vec4 color = frame.shade(word, x, y);
      s.words[i] = word;
      s.r[i] = color.x;
      s.g[i] = color.y;
      s.b[i] = color.z;
      s.a[i] = color.w;
      parallel::atomic_or(s.takers[p][i / 64], std::uint64_t{1} << i % 64);
    }
  }

  RASTRUM_HD void take(Pixel& pixel, std::size_t p, Scratch& s) const {
    for (std::size_t w = 0; w < Scratch::kSegmentWords; ++w) {
      for (std::uint64_t bits = s.takers[p][w]; bits != 0; bits &= bits - 1) {
        const std::size_t i = w * 64 + static_cast<std::size_t>(parallel::lowest_bit(bits));
        pixel.take({s.words[i], {s.r[i], s.g[i], s.b[i], s.a[i]}}, frame.opaque_at);
      }
      s.takers[p][w] = 0;
    }
    s.limit[p] = pixel.limit(s.opaque[p]);
  }

  RASTRUM_HD void finish(Pixel& pixel, std::size_t b, std::size_t p,
                         std::span<const raster::Block> mine, Scratch& s) const {
    const std::size_t at = b * 64 + p;
    pixel.end(frame.opaque_at);
    if (!pixel.misplaced()) {
      frame.colors[at] = pixel.color(frame.colors[at]);
      frame.words[at] = pixel.nearest();
      return;
    }
    parallel::atomic_add(s.repaired, 1U);
    const int x = frame.x_of(b, p), y = frame.y_of(b, p);
    const auto walk = [&](const auto& f) {
      for (std::size_t k = 0; k < mine.size(); ++k) {
        const raster::Block& record = mine[s.order[k]];
        if ((record.mask >> p & 1) == 0) continue;
        const std::uint64_t word = frame.word(frame.pieces[record.piece], x, y);
        if (word > s.opaque[p]) f(word);
      }
    };
    std::uint64_t nearest = 0;
    const SeenPixel seen = blend_in_windows(
        walk, [&](std::uint64_t word) { return frame.shade(word, x, y); }, frame.opaque_at,
        nearest);
    frame.colors[at] = over(seen, frame.colors[at]);
    frame.words[at] = nearest;
  }
};

}  // namespace rastrum::transparency::cuda
