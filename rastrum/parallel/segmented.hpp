// SPDX-License-Identifier: BSD-3-Clause
// segmented_scan: a scan of each segment by itself.
//
// Segment s is [first[s], first[s + 1]); the last one ends at n. (Futhark's library takes flags,
// which cannot express empty segments.) The operator must be associative. The result is as
// deterministic as reduce's: segments are cut at blocks of kBlock elements, and the pieces and then
// their results are folded from the left. Work O(n + segments + n / kBlock · log segments), span
// O(kBlock + n / kBlock), however long a segment is. Allocates one T per block. Source: Futhark's
// segmented library (paper 1, section 2.2.2); Blelloch, 1990.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/reduce.hpp>

namespace rastrum::parallel {
namespace segmented_detail {

/// Calls f(segment, begin, end) for each segment's non-empty share of [begin, end).
template <class First, class F>
RASTRUM_HD void for_each_run(const First& first, std::size_t begin, std::size_t end, F&& f) {
  const std::size_t segments = std::size(first);
  std::size_t low = 0, high = segments;  // find the last segment that begins at or before `begin`
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (static_cast<std::size_t>(first[middle]) <= begin ? low : high) = middle;
  }
  for (std::size_t s = low; begin < end; ++s) {
    std::size_t stop = s + 1 < segments ? static_cast<std::size_t>(first[s + 1]) : end;
    if (stop > end) stop = end;
    if (stop <= begin) continue;
    f(s, begin, stop);
    begin = stop;
  }
}

template <class First>
[[nodiscard]] RASTRUM_HD bool begins_at(const First& first, std::size_t segment, std::size_t i) {
  return static_cast<std::size_t>(first[segment]) == i;
}

// Passes over blocks: named functors over views, so that devices can run them.

/// Finds the sum of a block's last run, and whether that run begins within the block.
template <class T, class First, class In, class Op>
struct SumLastRun {
  First first;
  In in;
  std::span<T> last;
  std::span<std::uint8_t> closed;
  Op op;
  RASTRUM_HD void operator()(std::size_t block, std::size_t begin, std::size_t end) const {
    Op plus = op;
    for_each_run(first, begin, end, [&](std::size_t s, std::size_t run, std::size_t stop) {
      if (stop != end) return;
      last[block] = fold_block<T>(in, run, stop, plus);
      closed[block] = begins_at(first, s, run) ? 1 : 0;
    });
  }
};

/// Makes last[b] the sum of block b's last segment from its begin. Runs on one thread.
template <class T, class Op>
struct CarryAcrossBlocks {
  std::span<T> last;
  std::span<const std::uint8_t> closed;
  Op op;
  RASTRUM_HD void operator()(std::size_t) const {
    Op plus = op;
    for (std::size_t b = 1; b < last.size(); ++b)
      if (closed[b] == 0) last[b] = static_cast<T>(plus(last[b - 1], last[b]));
  }
};

template <class T, class First, class In, class Out, class Op>
struct ScanRuns {
  First first;
  In in;
  Out out;
  std::span<const T> last;
  Op op;
  RASTRUM_HD void operator()(std::size_t block, std::size_t begin, std::size_t end) const {
    Op plus = op;
    for_each_run(first, begin, end, [&](std::size_t s, std::size_t run, std::size_t stop) {
      const bool carried = !begins_at(first, s, run);
      T sum = static_cast<T>(in[run]);
      for (std::size_t i = run;;) {
        const T before = sum;
        if (i + 1 < stop) sum = static_cast<T>(plus(sum, static_cast<T>(in[i + 1])));
        out[i] = carried ? static_cast<T>(plus(last[block - 1], before)) : before;
        if (++i == stop) break;
      }
    });
  }
};

template <class T, class Exec, class First, class In, class Out, class Op>
void scan_in_blocks(Exec& exec, First first, In in, Out out, Op op) {
  const std::size_t n = std::size(in);
  auto last = make_buffer<T>(exec, block_count(n));
  auto closed = make_buffer<std::uint8_t>(exec, block_count(n));
  const auto last_view = view_of(last);
  const auto closed_view = view_of(closed);
  for_each_block(exec, n, SumLastRun<T, First, In, Op>{first, in, last_view, closed_view, op});
  for_each_index(exec, 1, CarryAcrossBlocks<T, Op>{last_view, closed_view, op});
  for_each_block(exec, n, ScanRuns<T, First, In, Out, Op>{first, in, out, last_view, op});
}

}  // namespace segmented_detail

/// out[i] = in[first[s]] op … op in[i], where s is the segment of i. Computes in T. `out` has the
/// size of `in` and may be `in`. Requires: `first` ascends, and first[0] = 0 unless there are no
/// segments and no elements.
template <class T, class Exec, Readable First, Readable In, Writable Out, class Op = std::plus<>>
void segmented_scan(Exec& exec, const First& first, const In& in, Out&& out, Op op = {}) {
  using namespace segmented_detail;
  assert(std::size(in) == std::size(out));
  assert(std::size(in) == 0 || (std::size(first) > 0 && begins_at(first, 0, 0)));
  scan_in_blocks<T>(exec, view_of(first), view_of(in), view_of(out), op);
}

}  // namespace rastrum::parallel
