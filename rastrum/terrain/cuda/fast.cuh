// SPDX-License-Identifier: BSD-3-Clause
// The fast path for a GPU, without paper 3's scans (its chapter 7 asks for that) and without the
// CPU's marks (fast.cpp), which need a second pass over the picture. A team walks the slices of
// kTeamColumns neighbouring columns near to far, kTeamSlices at a time:
//
// 1. All members find the first rows of the samples; neighbours take neighbouring columns.
// 2. One member per column turns them into running minima, in shared memory.
// 3. All members find the colours of the visible samples.
// 4. All members write the pixels that these samples uncovered, row by row. A pixel's sample is the
//    first whose running minimum is not below it, which a binary search finds. So each pixel is
//    written once, and nothing is read back.
//
// Before that, each member tests for one group of slices whether even the highest cells under it
// would stay hidden (ceiling.hpp; `classic` has its own bound). All skip such groups.
//
// `Walk` says where samples lie: PlanarWalk here, FunctionWalk in functions.cuh, ClassicWalk in
// classic.cuh. Work O(columns · slices), span O(slices / kTeamSlices · (kTeamSlices + rows)). The
// sizes are not measured: 1,920 columns give about as many teams as an A100 or H100 has
// multiprocessors.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/terrain/fan.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

inline constexpr std::size_t kTeamColumns = 16, kTeamSlices = 16, kTeamGroups = 256;
inline constexpr int kTeamThreads = 256;

/// A column drawn from the returned row on, or from above it, shows nothing below `row`.
template <class Real>
[[nodiscard]] RASTRUM_HD std::int32_t bound_of_row(Real row, std::int32_t height) {
  if (!(row > 0)) return 0;  // also if NaN, which bounds nothing
  return row < static_cast<Real>(height) ? static_cast<std::int32_t>(row) : kNoRow;
}

/// The samples of setup.hpp; derived walks bound them.
template <class AnySamples>
struct SamplesWalk {
  AnySamples samples;

  [[nodiscard]] RASTRUM_HD std::size_t columns() const { return samples.setup.ux.size(); }
  [[nodiscard]] RASTRUM_HD std::size_t slices() const { return samples.setup.slices.size(); }
  [[nodiscard]] RASTRUM_HD std::int32_t height() const { return samples.setup.height; }
  [[nodiscard]] RASTRUM_HD Rgba8 sky() const { return samples.setup.sky; }
  [[nodiscard]] RASTRUM_HD std::int32_t first_row(std::size_t column, std::size_t k) const {
    const Slice& slice = samples.setup.slices[k];
    return samples.setup.first_row(samples.height(column, slice), slice);
  }
  [[nodiscard]] RASTRUM_HD Rgba8 color(std::size_t column, std::size_t k) const {
    return samples.color(column, samples.setup.slices[k]);
  }
  [[nodiscard]] RASTRUM_HD float depth(std::size_t k) const { return samples.setup.slices[k].z; }
  /// Whether no column shows anything from slice k on if all are drawn from row `deepest` on.
  [[nodiscard]] RASTRUM_HD bool ends(std::int32_t deepest, std::size_t k) const {
    return static_cast<float>(deepest) <= samples.setup.slices[k].lowest_row;
  }
};

struct PlanarWalk : SamplesWalk<MapSamples> {
  CeilingView ceiling;

  /// No sample of columns [first, first + n) on slices [begin, end) rises above this row.
  [[nodiscard]] RASTRUM_HD std::int32_t lowest_row(std::size_t first, std::size_t n,
                                                   std::size_t begin, std::size_t end) const {
    const float row = Fan(samples.setup, first, n)
                          .lowest_row(samples, ceiling, samples.setup.slices[begin],
                                      samples.setup.slices[end - 1]);
    return bound_of_row(row, height());
  }
};

namespace cuda_detail {

/// In shared memory.
struct TeamColumns {
  std::int32_t row[kTeamSlices][kTeamColumns];              ///< running minima
  std::uint32_t color[kTeamSlices][kTeamColumns];           ///< bits of an Rgba8
  std::int32_t before[kTeamColumns], hidden[kTeamColumns];  ///< rows from there on are drawn
  std::uint32_t visible[kTeamColumns];
  std::int32_t lowest[kTeamGroups];
};

template <class Walk>
struct WalkColumns {
  Walk walk;
  TerrainTargets targets;
  std::span<std::uint64_t> samples, visible;  ///< of each team

  template <class Team>
  RASTRUM_HD void operator()(std::size_t block, TeamColumns& shared, const Team& team) const {
    const std::size_t first = block * kTeamColumns;
    const std::size_t left = walk.columns() - first;
    const std::size_t n = left < kTeamColumns ? left : kTeamColumns;
    for (std::size_t c = team.rank(); c < n; c += team.size()) {
      shared.hidden[c] = walk.height();
      shared.visible[c] = 0;
    }
    team.sync();
    std::size_t groups_walked = 0;
    constexpr std::size_t kBatch = kTeamGroups * kTeamSlices;
    for (std::size_t k = 0; k < walk.slices(); k += kBatch) {
      find_bounds(first, n, k, shared, team);
      team.sync();
      const std::size_t rest = (walk.slices() - k + kTeamSlices - 1) / kTeamSlices;
      for (std::size_t g = 0; g < kTeamGroups && g < rest; ++g) {
        const std::size_t begin = k + g * kTeamSlices;
        const std::int32_t deepest = greatest(shared.hidden, n);
        if (deepest == 0 || walk.ends(deepest, begin))
          return finish(block, groups_walked, n, shared, team);
        if (deepest <= shared.lowest[g]) continue;
        draw_group(first, n, begin, shared, team);
        ++groups_walked;
      }
      team.sync();  // before the bounds change
    }
    finish(block, groups_walked, n, shared, team);
  }

 private:
  [[nodiscard]] RASTRUM_HD static std::int32_t greatest(const std::int32_t* rows, std::size_t n) {
    std::int32_t most = rows[0];
    for (std::size_t c = 1; c < n; ++c) most = rows[c] > most ? rows[c] : most;
    return most;
  }
  [[nodiscard]] RASTRUM_HD static std::int32_t least(const std::int32_t* rows, std::size_t n) {
    std::int32_t most = rows[0];
    for (std::size_t c = 1; c < n; ++c) most = rows[c] < most ? rows[c] : most;
    return most;
  }

  /// One group of slices per member, from k on.
  template <class Team>
  RASTRUM_HD void find_bounds(std::size_t first, std::size_t n, std::size_t k, TeamColumns& shared,
                              const Team& team) const {
    for (std::size_t g = team.rank(); g < kTeamGroups; g += team.size()) {
      const std::size_t begin = k + g * kTeamSlices, end = begin + kTeamSlices;
      if (begin >= walk.slices()) return;
      shared.lowest[g] =
          walk.lowest_row(first, n, begin, end < walk.slices() ? end : walk.slices());
    }
  }

  template <class Team>
  RASTRUM_HD void draw_group(std::size_t first, std::size_t n, std::size_t begin,
                             TeamColumns& shared, const Team& team) const {
    constexpr std::size_t kSamples = kTeamSlices * kTeamColumns;
    for (std::size_t i = team.rank(); i < kSamples; i += team.size()) {
      const std::size_t s = i / kTeamColumns, c = i % kTeamColumns, k = begin + s;
      shared.row[s][c] = c < n && k < walk.slices() ? walk.first_row(first + c, k) : kNoRow;
    }
    team.sync();
    for (std::size_t c = team.rank(); c < n; c += team.size()) hide(c, shared);
    team.sync();
    if (!targets.color8.empty())
      for (std::size_t i = team.rank(); i < kSamples; i += team.size()) {
        const std::size_t s = i / kTeamColumns, c = i % kTeamColumns;
        if (c < n && shared.row[s][c] < (s > 0 ? shared.row[s - 1][c] : shared.before[c]))
          shared.color[s][c] = std::bit_cast<std::uint32_t>(walk.color(first + c, begin + s));
      }
    team.sync();
    write_pixels(first, n, begin, shared, team);
    team.sync();
  }

  RASTRUM_HD static void hide(std::size_t c, TeamColumns& shared) {
    std::int32_t hidden = shared.hidden[c];
    shared.before[c] = hidden;
    for (std::size_t s = 0; s < kTeamSlices; ++s) {
      if (shared.row[s][c] < hidden) {
        hidden = shared.row[s][c];
        ++shared.visible[c];
      }
      shared.row[s][c] = hidden;
    }
    shared.hidden[c] = hidden;
  }

  template <class Team>
  RASTRUM_HD void write_pixels(std::size_t first, std::size_t n, std::size_t begin,
                               const TeamColumns& shared, const Team& team) const {
    const std::int32_t top = least(shared.hidden, n), bottom = greatest(shared.before, n);
    const std::size_t pixels = static_cast<std::size_t>(bottom - top) * kTeamColumns;
    for (std::size_t i = team.rank(); i < pixels; i += team.size()) {
      const std::size_t c = i % kTeamColumns;
      const std::int32_t y = top + static_cast<std::int32_t>(i / kTeamColumns);
      if (c >= n || y < shared.hidden[c] || y >= shared.before[c]) continue;
      // The first of these minima that is not below y; there is one.
      std::size_t low = 0, high = kTeamSlices - 1;
      while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (shared.row[middle][c] <= y)
          high = middle;
        else
          low = middle + 1;
      }
      const int x = static_cast<int>(first + c);
      if (!targets.color8.empty())
        targets.color8(x, y) = std::bit_cast<Rgba8>(shared.color[low][c]);
      if (!targets.depth.empty()) targets.depth(x, y) = walk.depth(begin + low);
    }
  }

  template <class Team>
  RASTRUM_HD void finish(std::size_t block, std::size_t groups, std::size_t n,
                         const TeamColumns& shared, const Team& team) const {
    const std::size_t pixels = static_cast<std::size_t>(greatest(shared.hidden, n)) * kTeamColumns;
    for (std::size_t i = team.rank(); i < pixels; i += team.size()) {
      const std::size_t c = i % kTeamColumns;
      const int x = static_cast<int>(block * kTeamColumns + c),
                y = static_cast<int>(i / kTeamColumns);
      if (c >= n || y >= shared.hidden[c]) continue;
      if (!targets.color8.empty()) targets.color8(x, y) = walk.sky();
      if (!targets.depth.empty()) targets.depth(x, y) = std::numeric_limits<float>::infinity();
    }
    if (team.rank() != 0) return;
    std::uint64_t sum = 0;
    for (std::size_t c = 0; c < n; ++c) sum += shared.visible[c];
    visible[block] = sum;
    samples[block] = groups * kTeamSlices * n;
  }
};

}  // namespace cuda_detail

/// `targets` and all that `walk` views lie on the device. Waits for the counts.
template <class Walk>
Counts draw_by_teams(parallel::Cuda& exec, const Walk& walk, const TerrainTargets& targets) {
  const std::size_t teams = (walk.columns() + kTeamColumns - 1) / kTeamColumns;
  auto samples = parallel::make_buffer<std::uint64_t>(exec, teams);
  auto visible = parallel::make_buffer<std::uint64_t>(exec, teams);
  parallel::for_each_team<cuda_detail::TeamColumns, kTeamThreads>(
      exec, teams,
      cuda_detail::WalkColumns<Walk>{walk, targets, parallel::view_of(samples),
                                     parallel::view_of(visible)});
  return {parallel::reduce(exec, samples, std::uint64_t{0}),
          parallel::reduce(exec, visible, std::uint64_t{0})};
}

}  // namespace rastrum::terrain
