// segmented_reduce_by_index: a generalized histogram for each segment by itself, small enough for a
// core's cache: what a tile does with its fragments.
//
// A thread has a segment's bins to itself, so nothing is atomic, and hands them to a sink while
// they are hot. Segments longer than kHistogramPiece (or four values a bin, if that is more) are
// cut into pieces with bins of their own, which are folded in order: one huge segment occupies all
// threads, and costs at most a quarter of a value in memory per value. The cut depends on the input
// alone: one result on every backend, also where the operator is associative only up to rounding.
//
// Work O(n + segments · bins), span O(piece + bins · pieces of a segment). Allocates the bins of
// one segment per thread, and of each piece of the long ones. Source: proposed as future work in
// paper 1, section 4.4; the sub-histograms of Henriksen et al., 2020.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>

#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/filter.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scratch.hpp>

namespace rastrum::parallel {

inline constexpr std::size_t kHistogramPiece = 16 * kBlock;

/// For each segment s = [first[s], first[s + 1]), the last one ending at n: bins of `neutral`, then
/// bin[indices[i]] = bin[indices[i]] op values[i] for all i of the segment in order, then
/// f(s, std::span<const T> of the bins), once per segment, in any order, also for empty ones.
/// Indices outside of [0, bins) are ignored. Sizes of `indices` and `values` agree; `first` ascends
/// from 0. The operator must be associative.
template <class Exec, Readable First, Readable Indices, Readable Values, class T, class Op, class F>
void segmented_reduce_by_index(Exec& exec, const First& first, const Indices& indices,
                               const Values& values, std::size_t bins, T neutral, Op op, F&& f) {
  assert(std::size(indices) == std::size(values));
  assert(std::size(indices) == 0 || (std::size(first) > 0 && first[0] == 0));
  const std::size_t n = std::size(indices), segments = std::size(first);
  const std::size_t per_piece = std::max(kHistogramPiece, 4 * bins);
  const auto begin_of = [&](std::size_t s) {
    return s < segments ? static_cast<std::size_t>(first[s]) : n;
  };
  const auto pieces_of = [&](std::size_t s) {
    return std::max<std::size_t>(1, (begin_of(s + 1) - begin_of(s) + per_piece - 1) / per_piece);
  };
  const auto fill = [&](std::size_t begin, std::size_t end, std::span<T> bin) {
    std::fill(bin.begin(), bin.end(), neutral);
    for (std::size_t i = begin; i < end; ++i) {
      if (std::cmp_less(indices[i], 0) || std::cmp_greater_equal(indices[i], bins)) continue;
      T& to = bin[static_cast<std::size_t>(indices[i])];
      to = static_cast<T>(op(to, static_cast<T>(values[i])));
    }
  };

  // Long segments first: their pieces' bins, then the pieces folded.
  const auto long_ones =
      filter(exec, counting(segments), [&](std::size_t s) { return pieces_of(s) > 1; });
  const Expansion pieces(exec, long_ones, pieces_of, 1);
  auto bins_of_pieces = make_buffer<T>(exec, pieces.size() * bins);
  const auto bins_of = [&](std::size_t piece) {
    return std::span(bins_of_pieces.data() + piece * bins, bins);
  };
  expand_each(exec, pieces, long_ones, [&](std::size_t piece, std::size_t s, std::size_t j) {
    const std::size_t begin = begin_of(s) + j * per_piece;
    fill(begin, std::min(begin + per_piece, begin_of(s + 1)), bins_of(piece));
  });
  for_each_index(exec, long_ones.size(), [&](std::size_t k) {
    const std::span<T> sum = bins_of(pieces.first(k));
    for (std::size_t piece = pieces.first(k) + 1; piece < pieces.segment_end(k); ++piece)
      for (std::size_t b = 0; b < bins; ++b) sum[b] = static_cast<T>(op(sum[b], bins_of(piece)[b]));
    f(long_ones[k], std::span<const T>(sum));
  });

  ScratchPool<Buffer<T>> scratch([&] { return make_buffer<T>(exec, bins); });
  for_each_with_scratch(exec, segments, scratch, [&](std::size_t s, Buffer<T>& bin) {
    if (pieces_of(s) > 1) return;
    fill(begin_of(s), begin_of(s + 1), bin);
    f(s, std::span<const T>(bin));
  });
}

}  // namespace rastrum::parallel
