// SPDX-License-Identifier: BSD-3-Clause
// Paper 3, chapter 4, in data-parallel words: makes colour–height pairs for all samples, scans each
// column by `occlude`, scatters into the columns of the picture, scans them down by `fill`, and
// transposes. Work O(n · m + l · m), span O(log) beside the words' blocks.
//
// One listing serves all backends: words.cpp has serial and threads, words.cu the device.
//
// Deviations. Segmented scans replace the maps over columns with scans inside. After the `occlude`
// scan a hidden sample repeats the pair before it, and no two writers may write one element here.
// So a pair is written only if its row differs from that of the pair before. Columns go in batches,
// which bounds the memory of the pairs.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include <papers/paper3/scans.hpp>
#include <rastrum/parallel/for_each.hpp>
#include <rastrum/parallel/reduce.hpp>
#include <rastrum/parallel/scatter.hpp>
#include <rastrum/parallel/segmented.hpp>
#include <rastrum/parallel/tabulate.hpp>
#include <rastrum/parallel/transpose.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::family {
namespace words_detail {

/// Pairs of a batch, 12 bytes each.
inline constexpr std::size_t kBatch = std::size_t{1} << 21;

/// Section 4.2: the pair of sample i of the batch, whose samples are stored column by column.
template <class AnySamples>
struct MakePair {
  AnySamples samples;
  std::size_t first_column;

  RASTRUM_HD Pair operator()(std::size_t i) const {
    const terrain::SetupView& setup = samples.setup;
    const std::size_t column = first_column + i / setup.slices.size();
    const terrain::Slice& slice = setup.slices[i % setup.slices.size()];
    const std::int32_t row = setup.first_row(samples.height(column, slice), slice);
    if (row == terrain::kNoRow) return kNoPair;
    return {samples.color(column, slice), slice.z, row};
  }
};

/// The index of a column's first element.
struct ColumnStart {
  std::size_t length;
  RASTRUM_HD std::size_t operator()(std::size_t column) const { return column * length; }
};

struct IsSeen {
  std::span<const Pair> pairs;
  std::size_t slices;
  RASTRUM_HD bool operator()(std::size_t i) const {
    return pairs[i].row != terrain::kNoRow && (i % slices == 0 || pairs[i].row != pairs[i - 1].row);
  }
};
struct CountSeen {
  IsSeen seen;
  RASTRUM_HD std::uint64_t operator()(std::size_t i) const { return seen(i) ? 1 : 0; }
};
struct PixelOfPair {
  std::span<const Pair> pairs;
  RASTRUM_HD Pixel operator()(std::size_t i) const { return {pairs[i].color, pairs[i].depth}; }
};
struct PlaceOfPair {
  std::span<const Pair> pairs;
  std::size_t slices, rows;
  RASTRUM_HD std::size_t operator()(std::size_t i) const {
    return i / slices * rows + static_cast<std::size_t>(pairs[i].row);
  }
};
struct EmptyPixel {
  RASTRUM_HD Pixel operator()(std::size_t) const { return {}; }
};

/// Writes pixel i of the batch's rows.
struct WritePixel {
  std::span<const Pixel> frame;
  std::size_t first_column, columns;
  Pixel sky;
  terrain::TerrainTargets targets;
  RASTRUM_HD void operator()(std::size_t i) const {
    const Pixel pixel = Fill{}(sky, frame[i]);
    const int x = static_cast<int>(first_column + i % columns), y = static_cast<int>(i / columns);
    if (!targets.color8.empty()) targets.color8(x, y) = pixel.color;
    if (!targets.depth.empty()) targets.depth(x, y) = pixel.depth;
  }
};

template <class Exec, class AnySamples>
std::uint64_t draw_columns(Exec& exec, const AnySamples& samples, std::size_t first, std::size_t m,
                           const terrain::TerrainTargets& targets) {
  using namespace parallel;
  const std::size_t n = samples.setup.slices.size();
  const auto l = static_cast<std::size_t>(samples.setup.height);

  auto pairs = make_buffer<Pair>(exec, n * m);
  tabulate(exec, pairs, MakePair<AnySamples>{samples, first});
  segmented_scan<Pair>(exec, Computed(m, ColumnStart{n}), pairs, pairs, Occlude{});

  auto screen = make_buffer<Pixel>(exec, l * m);
  tabulate(exec, screen, EmptyPixel{});
  const std::span<const Pair> seen(pairs.data(), pairs.size());
  scatter_if(exec, Computed(n * m, PixelOfPair{seen}), Computed(n * m, PlaceOfPair{seen, n, l}),
             Computed(n * m, IsSeen{seen, n}), screen);
  segmented_scan<Pixel>(exec, Computed(m, ColumnStart{l}), screen, screen, Fill{});

  auto frame = make_buffer<Pixel>(exec, l * m);
  transpose(exec, screen, m, l, frame);
  const Pixel sky{samples.setup.sky, std::numeric_limits<float>::infinity()};
  for_each(exec, counting(l * m), WritePixel{{frame.data(), frame.size()}, first, m, sky, targets});
  return reduce(exec, Computed(n * m, CountSeen{{seen, n}}), std::uint64_t{0});
}

}  // namespace words_detail

/// Draws Samples or MapSamples. Samples and targets are in the memory of `exec`.
template <class Exec, class AnySamples>
terrain::Counts draw_by_words(Exec& exec, const AnySamples& samples,
                              const terrain::TerrainTargets& targets) {
  const std::size_t columns = samples.setup.ux.size(), n = samples.setup.slices.size();
  const std::size_t longest = std::max(n, static_cast<std::size_t>(samples.setup.height));
  const std::size_t batch = std::clamp<std::size_t>(words_detail::kBatch / longest, 1, columns);
  terrain::Counts counts{n * columns, 0};
  for (std::size_t first = 0; first < columns; first += batch)
    counts.visible +=
        words_detail::draw_columns(exec, samples, first, std::min(batch, columns - first), targets);
  return counts;
}

}  // namespace rastrum::family
