// SPDX-License-Identifier: BSD-3-Clause
// expand_each: an expansion that is walked instead of written. Like expand it makes one element of
// the result out of segment i and j in [0, size(in[i])), but hands (in[i], j) to a sink; nothing of
// the result is held in memory. Where a sink must know how much there is before it writes, the
// expansion is walked twice.
//
// The results are cut into chunks of equal size, whose number is known beforehand. The cut depends
// on the segment sizes and `per_chunk` alone: at every walk, on every backend, with any number of
// threads a chunk holds the same results in the same order. So a first walk can count what each
// chunk has to say, a scan gives the chunks their places, and a second walk writes. One huge
// segment is balanced as well as millions of small ones; a chunk finds its first segment by binary
// search.
//
// Work O(n + total), span O(per_chunk + log n). Allocates 8 bytes per segment.
// Source: expand is paper 1, section 2.2.2; the walk without an array is ours.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <utility>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/transform.hpp>

namespace rastrum::parallel {

namespace expand_detail {

/// The size of a segment, as a functor that a device can call.
template <class Size>
struct SizeOf {
  Size size;
  template <class X>
  RASTRUM_HD std::size_t operator()(const X& x) const {
    return static_cast<std::size_t>(size(x));
  }
};

/// The last place in the ascending `first` whose value is ≤ `value`; first[0] ≤ value.
template <class First>
[[nodiscard]] RASTRUM_HD constexpr std::size_t last_at_most(const First& first, std::size_t value) {
  std::size_t low = 0;
  for (std::size_t n = std::size(first); n > 1;) {
    const std::size_t half = n / 2;
    if (first[low + half] <= value) low += half;
    n -= half;
  }
  return low;
}

}  // namespace expand_detail

/// Results of a chunk where the caller does not say: one thread makes them.
template <class Exec>
inline constexpr std::size_t kResultsPerChunk = kBlock;

/// How many results there are, and their cut into chunks of equal size.
class ChunkCut {
 public:
  ChunkCut(std::size_t size, std::size_t per_chunk) : size_(size), per_chunk_(per_chunk) {
    assert(per_chunk > 0);
  }
  /// Number of results.
  [[nodiscard]] RASTRUM_HD std::size_t size() const { return size_; }
  [[nodiscard]] RASTRUM_HD std::size_t per_chunk() const { return per_chunk_; }
  [[nodiscard]] RASTRUM_HD std::size_t chunks() const {
    return (size_ + per_chunk_ - 1) / per_chunk_;
  }
  /// Chunk c holds the results [chunk_begin(c), chunk_end(c)).
  [[nodiscard]] RASTRUM_HD std::size_t chunk_begin(std::size_t c) const { return c * per_chunk_; }
  [[nodiscard]] RASTRUM_HD std::size_t chunk_end(std::size_t c) const {
    const std::size_t end = (c + 1) * per_chunk_;
    return end < size_ ? end : size_;
  }

 protected:
  void set_size(std::size_t size) { size_ = size; }

 private:
  std::size_t size_, per_chunk_;
};

/// Where the results of each segment lie, and how they are cut into chunks. `First` is an array of
/// numbers: a backend's buffer, or a view of one.
template <class First>
class BasicExpansion : public ChunkCut {
 public:
  /// Calls size(in[i]) → integer ≥ 0 once per segment. Requires per_chunk > 0.
  template <class Exec, Readable In, class Size>
  BasicExpansion(Exec& exec, const In& in, const Size& size,
                 std::size_t per_chunk = kResultsPerChunk<Exec>)
      : ChunkCut(0, per_chunk), first_(make_buffer<std::size_t>(exec, std::size(in))) {
    transform(exec, in, first_, expand_detail::SizeOf<Size>{size});
    set_size(exclusive_scan(exec, first_, first_, std::size_t{0}));
  }
  BasicExpansion(First first, const ChunkCut& cut) : ChunkCut(cut), first_(first) {}

  /// The form that kernels take; must not outlive this.
  [[nodiscard]] BasicExpansion<std::span<const std::size_t>> view() const {
    return {std::span<const std::size_t>(first_.data(), first_.size()), *this};
  }

  [[nodiscard]] RASTRUM_HD std::size_t segments() const { return first_.size(); }
  /// The result with which segment i begins: first(i) + j is made from its j.
  [[nodiscard]] RASTRUM_HD std::size_t first(std::size_t i) const { return first_[i]; }
  [[nodiscard]] RASTRUM_HD std::size_t segment_end(std::size_t i) const {
    return i + 1 < first_.size() ? first_[i + 1] : size();
  }
  /// The segment that makes `result`; requires result < size(). O(log n).
  [[nodiscard]] RASTRUM_HD std::size_t segment_of(std::size_t result) const {
    // Empty segments begin where the next one does: the last of them is meant.
    return expand_detail::last_at_most(first_, result);
  }

 private:
  First first_;
};
using Expansion = BasicExpansion<Buffer<std::size_t>>;

/// The expansion of a backend, for listings that are written for any.
template <class Exec, Readable In, class Size>
[[nodiscard]] auto make_expansion(Exec& exec, const In& in, const Size& size,
                                  std::size_t per_chunk = kResultsPerChunk<Exec>) {
  return BasicExpansion<decltype(make_buffer<std::size_t>(exec, 0))>(exec, in, size, per_chunk);
}

/// One chunk of an expansion, to be walked in order. Borrows the expansion and its input.
template <class In, class Plan = Expansion>
class ExpansionChunk {
 public:
  RASTRUM_HD ExpansionChunk(const Plan& expansion, const In& in, std::size_t index)
      : expansion_(&expansion), in_(&in), index_(index) {}

  [[nodiscard]] RASTRUM_HD std::size_t index() const { return index_; }
  /// The results it holds: begin() is the number of the first one.
  [[nodiscard]] RASTRUM_HD std::size_t begin() const { return expansion_->chunk_begin(index_); }
  [[nodiscard]] RASTRUM_HD std::size_t end() const { return expansion_->chunk_end(index_); }
  [[nodiscard]] RASTRUM_HD std::size_t size() const { return end() - begin(); }

  /// Calls f(in[i], j_begin, j_end) for each segment's share of the chunk, which is not empty: for
  /// sinks that have something to do once per segment.
  template <class F>
  RASTRUM_HD void each_run(F&& f) const {
    const std::size_t stop = end();
    std::size_t i = expansion_->segment_of(begin());
    for (std::size_t k = begin(); k < stop; ++i) {
      const std::size_t segment_end = expansion_->segment_end(i);
      const std::size_t run_end = segment_end < stop ? segment_end : stop;
      if (k == run_end) continue;
      const std::size_t first = expansion_->first(i);
      f((*in_)[i], k - first, run_end - first);
      k = run_end;
    }
  }
  /// Calls f(in[i], j) for each result of the chunk.
  template <class F>
  RASTRUM_HD void each(F&& f) const {
    each_run([&](const auto& element, std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) f(element, j);
    });
  }

 private:
  const Plan* expansion_;
  const In* in_;
  std::size_t index_;
};

/// Calls f(chunk) for each chunk of an expansion of `in`, each by one thread, in any order: for
/// sinks that hold something per chunk (a counter in a register, a buffer that is flushed).
template <class Exec, Readable In, class F>
void expand_chunks(Exec& exec, const Expansion& expansion, const In& in, F&& f) {
  assert(std::size(in) == expansion.segments());
  for_each_index(exec, expansion.chunks(),
                 [&](std::size_t c) { f(ExpansionChunk<In>(expansion, in, c)); });
}

/// Calls f(chunk, in[i], j) for each result, in order within a chunk; chunk < expansion.chunks() is
/// its number. Calls of one chunk come from one thread.
template <class Exec, Readable In, class F>
void expand_each(Exec& exec, const Expansion& expansion, const In& in, F&& f) {
  expand_chunks(exec, expansion, in, [&](const ExpansionChunk<In>& chunk) {
    chunk.each([&, c = chunk.index()](const auto& element, std::size_t j) { f(c, element, j); });
  });
}

}  // namespace rastrum::parallel
