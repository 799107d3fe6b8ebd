// segmented_scan and segmented_reduce: a scan or a reduction of each segment by itself.
//
// Segments are given by where they begin: segment s is [first[s], first[s + 1]), the last one ends
// at n. Futhark's library takes flags instead, which cannot say that a segment is empty; and first
// is what an expansion has (Expansion::first).
// The operator must be associative. Where that holds only up to rounding the result is still one: a
// segment is cut where blocks of kBlock elements begin, the pieces are folded from the left, and so
// are their results, whatever the backend and the number of threads.
// Work O(n + segments + n / kBlock · log segments), span O(kBlock + n / kBlock), however long one
// segment is. Allocates the result of segmented_reduce, and one T per block.
// Source: Futhark's segmented library (paper 1, section 2.2.2); Blelloch, 1990.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/reduce.hpp>
#include <rastrum/parallel/tabulate.hpp>

namespace rastrum::parallel {
namespace segmented_detail {

/// Calls f(segment, begin, end) for each segment's share of [begin, end) that is not empty.
template <class First, class F>
void for_each_run(const First& first, std::size_t begin, std::size_t end, F&& f) {
  const std::size_t segments = std::size(first);
  const auto at = [&](std::size_t s) { return static_cast<std::size_t>(first[s]); };
  std::size_t low = 0, high = segments;  // the last segment that begins at or before `begin`
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (at(middle) <= begin ? low : high) = middle;
  }
  for (std::size_t s = low; begin < end; ++s) {
    const std::size_t stop = s + 1 < segments ? std::min(end, at(s + 1)) : end;
    if (stop <= begin) continue;
    f(s, begin, stop);
    begin = stop;
  }
}

template <class First>
[[nodiscard]] bool begins_at(const First& first, std::size_t segment, std::size_t i) {
  return static_cast<std::size_t>(first[segment]) == i;
}

}  // namespace segmented_detail

/// out[i] = in[first[s]] op … op in[i], s being the segment of i. `out` has the size of `in` and
/// may be `in`. Requires: `first` ascends, first[0] = 0 unless there is no segment and no element.
/// Computes in T.
template <class T, class Exec, Readable First, Readable In, Writable Out, class Op = std::plus<>>
void segmented_scan(Exec& exec, const First& first, const In& in, Out&& out, Op op = {}) {
  using namespace segmented_detail;
  assert(std::size(in) == std::size(out));
  const std::size_t n = std::size(in);
  assert(n == 0 || (std::size(first) > 0 && begins_at(first, 0, 0)));
  // What a block's last run sums up to, and whether that run begins within the block.
  auto last = make_buffer<T>(exec, block_count(n));
  auto closed = make_buffer<std::uint8_t>(exec, block_count(n));
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for_each_run(first, begin, end, [&](std::size_t s, std::size_t run, std::size_t stop) {
      if (stop != end) return;
      last[block] = fold_block<T>(in, run, stop, op);
      closed[block] = begins_at(first, s, run) ? 1 : 0;
    });
  });
  // From here on: the sum of the segment that runs into the next block.
  for (std::size_t b = 1; b < last.size(); ++b)
    if (closed[b] == 0) last[b] = static_cast<T>(op(last[b - 1], last[b]));
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for_each_run(first, begin, end, [&](std::size_t s, std::size_t run, std::size_t stop) {
      const bool carried = !begins_at(first, s, run);
      T sum = static_cast<T>(in[run]);
      for (std::size_t i = run;;) {
        const T before = sum;
        if (i + 1 < stop) sum = static_cast<T>(op(sum, static_cast<T>(in[i + 1])));
        out[i] = carried ? static_cast<T>(op(last[block - 1], before)) : before;
        if (++i == stop) break;
      }
    });
  });
}

/// One value per segment: in[first[s]] op … , `neutral` where the segment is empty. `first` as
/// above. Computes in the type of `neutral`.
template <class Exec, Readable First, Readable In, class T, class Op = std::plus<>>
[[nodiscard]] Buffer<T> segmented_reduce(Exec& exec, const First& first, const In& in, T neutral,
                                         Op op = {}) {
  using namespace segmented_detail;
  const std::size_t n = std::size(in);
  assert(n == 0 || (std::size(first) > 0 && begins_at(first, 0, 0)));
  auto out = make_buffer<T>(exec, std::size(first));
  tabulate(exec, out, [&](std::size_t) { return neutral; });
  // A block's first piece, where it continues a segment of the block before it.
  struct Carried {
    T piece;
    std::size_t segment;
  };
  auto carried = make_buffer<Carried>(exec, block_count(n));
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    carried[block].segment = std::size(first);
    for_each_run(first, begin, end, [&](std::size_t s, std::size_t run, std::size_t stop) {
      const T piece = fold_block<T>(in, run, stop, op);
      if (begins_at(first, s, run))
        out[s] = piece;
      else
        carried[block] = {piece, s};
    });
  });
  for (const Carried& c : carried)
    if (c.segment < out.size()) out[c.segment] = static_cast<T>(op(out[c.segment], c.piece));
  return out;
}

}  // namespace rastrum::parallel
