// SPDX-License-Identifier: BSD-3-Clause
// An 8 × 8 block by a team, for records that fit into shared memory: paper 4, stage 3, phases 2
// and 3.
//
// The records (piece, mask) are sorted by the depth at their samples' centroid, and their samples
// are numbered by a prefix sum. Segments of samples are shaded, one per thread whatever its pixel.
// A pixel's thread then takes its samples in order, through the depth filter. Pixels that it could
// not order are blended again, exactly, by their thread alone.
//
// With several samples per pixel a team blends four at once, and a thread takes one sample of a
// pixel.
//
// Where it deviates: a team owns a block, not a bin of 16, because records have their masks from
// binning and need no second division. So many small teams are in flight, and low and high density
// are two sizes of one kernel. Sorting uses shared memory, not shuffles within warps.
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

/// Block b's records begin at first[b] less `skipped` and number counts[b], or go up to first[b +
/// 1] if `counts` is empty.
struct RecordView {
  const raster::Block* records;
  std::span<const std::uint64_t> first;
  std::uint64_t skipped = 0;
  std::span<const std::uint32_t> counts{};

  RASTRUM_HD std::span<const raster::Block> of(std::size_t b) const {
    const std::uint64_t n = counts.empty() ? first[b + 1] - first[b] : counts[b];
    return {records + (first[b] - skipped), static_cast<std::size_t>(n)};
  }
};

enum Counter : std::size_t {
  kFragments,
  kDeepest,
  kRepaired,
  kCounters,
  kStaged = kCounters,  ///< records that were found
  kPlaced,              ///< records that have their place
  kBoxRuns,
  kLowBlocks,
  kHighBlocks,
  kDeepBlocks,
  kQueueCounters
};

RASTRUM_HD inline void count_layers(std::uint64_t* counters, std::uint64_t fragments,
                                    std::uint32_t deepest, std::uint64_t repaired) {
  if (fragments == 0) return;
  parallel::add_to_sum(counters[kFragments], fragments);
  parallel::raise_maximum(counters[kDeepest], deepest);
  if (repaired != 0) parallel::add_to_sum(counters[kRepaired], repaired);
}

/// Low density: two warps, a thread per pixel (with four samples, per sample), in 9 KiB. High: 48
/// KiB, with more threads to shade and sort. With the lit shaders nvcc 13 gives a thread 161
/// registers on sm_90, so 6 teams of low density fit a multiprocessor; held to 128, 8 of them are 3
/// to 6 % faster on an H200, and 10 no faster than 8.
struct LowDensity {
  static constexpr std::size_t kRecords = 256, kSegment = 128;
  static constexpr int kThreads = 64;
  static constexpr int kResident = 8;
};
struct HighDensity {
  static constexpr std::size_t kRecords = 2048, kSegment = 256;
  static constexpr int kThreads = 256;
  static constexpr int kResident = 0;
};

template <class Density, std::size_t samples>
struct BlockScratch {
  static constexpr std::size_t kSegmentWords = Density::kSegment / 32;
  static constexpr std::size_t kPlaces = 64 * samples;  ///< each sample's pixels

  std::uint64_t sort_keys[Density::kRecords];
  std::uint16_t order[Density::kRecords];          ///< of the records, as sorted
  std::uint32_t first[Density::kRecords + 1];      ///< first sample of each sorted record
  std::uint64_t keys[samples][Density::kSegment];  ///< of its samples; 0: none
  float r[Density::kSegment], g[Density::kSegment], b[Density::kSegment], a[Density::kSegment];
  std::uint32_t takers[64][kSegmentWords];  ///< samples of the segment, per pixel
  std::uint64_t opaque[kPlaces], limit[kPlaces];
  std::uint32_t layers[kPlaces];
};

template <class Density, class Pixel, class Frame>
struct BlendBlock {
  static constexpr int kSamples = Frame::kSamples;
  using Scratch = BlockScratch<Density, std::size_t{kSamples}>;
  static_assert(sizeof(Scratch) <= 48 * 1024);
  static constexpr int kThreads =
      Density::kThreads < 64 * kSamples ? 64 * kSamples : Density::kThreads;
  static constexpr int kResident = kThreads == Density::kThreads ? Density::kResident : 0;
  static constexpr std::size_t kMembers = parallel::cuda_system::kTeamMembers<kThreads>;
  /// Places that a member owns: one, if there are threads enough. Place 64 · s + p is sample s of
  /// pixel p.
  static constexpr std::size_t kShare = (Scratch::kPlaces + kMembers - 1) / kMembers;

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
    each_own(team, [&](std::size_t k, std::size_t q) {
      pixels[k].begin(frame.color_of(sample_of(q), b * 64 + q % 64));
    });
    for (std::size_t begin = 0; begin < total; begin += Density::kSegment) {
      const std::size_t left = total - begin;
      shade(b, mine, begin, left < Density::kSegment ? left : Density::kSegment, s, team);
      team.sync();
      each_own(team, [&](std::size_t k, std::size_t q) { take(pixels[k], q, s); });
      if constexpr (kSamples > 1) team.sync();  // all samples of a pixel read its takers
      each_own(team, [&](std::size_t, std::size_t q) { clear_takers(q, s); });
      team.sync();
    }
    std::uint32_t fragments = 0, deepest = 0, repaired = 0;
    each_own(team, [&](std::size_t k, std::size_t q) {
      const std::uint32_t layers = s.layers[q];
      if (layers == 0) return;
      fragments += layers;
      if (layers > deepest) deepest = layers;
      repaired += finish(pixels[k], b, q, mine, s) ? 1U : 0U;
    });
    count_layers(counters, fragments, deepest, repaired);
  }

 private:
  RASTRUM_HD static int sample_of(std::size_t q) { return static_cast<int>(q / 64); }
  /// Unrolled, so that a pixel stays in registers.
  template <class Team, class F>
  RASTRUM_HD static void each_own(const Team& team, const F& f) {
    for (std::size_t k = 0; k < kShare; ++k) {
      const std::size_t q = team.rank() + k * team.size();
      if (q < Scratch::kPlaces) f(k, q);
    }
  }

  RASTRUM_HD static void clear_takers(std::size_t q, Scratch& s) {
    if (q < 64)
      for (std::uint32_t& bits : s.takers[q]) bits = 0;
  }

  template <class Team>
  RASTRUM_HD void prepare(std::size_t b, std::span<const raster::Block> mine, Scratch& s,
                          const Team& team) const {
    for (std::size_t k = team.rank(); k < mine.size(); k += team.size())
      s.sort_keys[k] = Pixel::record_sort_key(frame.pieces[mine[k].piece], mine[k]);
    each_own(team, [&](std::size_t, std::size_t q) {
      s.opaque[q] = s.limit[q] = frame.key_of(sample_of(q), b * 64 + q % 64);
      s.layers[q] = 0;
      clear_takers(q, s);
    });
    sort(s, mine.size(), team);
    for (std::size_t k = team.rank(); k < mine.size(); k += team.size())
      s.first[k] = static_cast<std::uint32_t>(parallel::popcount(mine[s.order[k]].mask));
    parallel::team_prefix_sums(s.first, mine.size(), team);
  }

  template <class Team>
  RASTRUM_HD static void sort(Scratch& s, std::size_t n, const Team& team) {
    if (n > Pixel::kAnyOrder) return parallel::team_order(s.sort_keys, s.order, n, team);
    for (std::size_t k = team.rank(); k < n; k += team.size())
      s.order[k] = static_cast<std::uint16_t>(k);
    team.sync();
  }

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
      std::uint64_t seen = 0;
      for (int sample = 0; sample < kSamples; ++sample) {
        const std::size_t q = static_cast<std::size_t>(sample) * 64 + p;
        std::uint64_t& key = s.keys[sample][i];
        key = frame.key(record, x, y, sample);
        if (key > s.opaque[q]) parallel::atomic_add(s.layers[q], 1U);
        // A limit is never below the opaque key.
        if (key <= s.limit[q])
          key = 0;
        else
          seen = key;
      }
      if (seen == 0) continue;
      const Vec4 color = frame.color(record.piece, seen, x, y);
      s.r[i] = color.x;
      s.g[i] = color.y;
      s.b[i] = color.z;
      s.a[i] = color.w;
      parallel::atomic_or(s.takers[p][i / 32], std::uint32_t{1} << i % 32);
    }
  }

  RASTRUM_HD void take(Pixel& pixel, std::size_t q, Scratch& s) const {
    for (std::size_t w = 0; w < Scratch::kSegmentWords; ++w)
      for (std::uint32_t bits = s.takers[q % 64][w]; bits != 0; bits &= bits - 1) {
        const std::size_t i = w * 32 + static_cast<std::size_t>(parallel::lowest_bit(bits));
        const std::uint64_t key = s.keys[q / 64][i];
        if (key == 0) continue;
        pixel.take({key, {s.r[i], s.g[i], s.b[i], s.a[i]}}, frame.opaque_at);
      }
    s.limit[q] = pixel.limit(s.opaque[q]);
  }

  /// Returns whether it had to be blended again.
  RASTRUM_HD bool finish(Pixel& pixel, std::size_t b, std::size_t q,
                         std::span<const raster::Block> mine, Scratch& s) const {
    const std::size_t p = q % 64;
    const int sample = sample_of(q);
    std::uint64_t& out = frame.key_of(sample, b * 64 + p);
    Vec4& color = frame.color_of(sample, b * 64 + p);
    pixel.end(frame.opaque_at);
    if (!pixel.misplaced()) {
      color = pixel.color(color);
      out = pixel.nearest();
      return false;
    }
    const int x = frame.x_of(b, p), y = frame.y_of(b, p);
    const auto walk = [&](const auto& f) {
      for (std::size_t k = 0; k < mine.size(); ++k) {
        const raster::Block& record = mine[s.order[k]];
        if ((record.mask >> p & 1) == 0) continue;
        const std::uint64_t key = frame.key(record, x, y, sample);
        if (key > s.opaque[q]) f(key);
      }
    };
    std::uint64_t nearest = 0;
    const SeenPixel seen = blend_in_windows(
        walk, [&](std::uint64_t key) { return frame.shade(key, x, y); }, frame.opaque_at, nearest);
    color = over(seen, color);
    out = nearest;
    return true;
  }
};

}  // namespace rastrum::transparency::cuda
