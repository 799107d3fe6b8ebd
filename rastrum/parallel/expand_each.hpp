// SPDX-License-Identifier: BSD-3-Clause
// expand_each: an expansion that is walked instead of written. It hands (in[i], j) for each j in
// [0, size(in[i])) to a sink, and stores no results.
//
// Chunks of equal size divide the results. The cut depends on the segment sizes and `per_chunk`
// alone, so a chunk is the same at every walk, on every backend, with any number of threads. A sink
// that needs its number of outputs beforehand walks twice: the first walk counts per chunk, a scan
// finds the places, the second walk writes. A chunk finds its first segment by binary search, so
// one huge segment is balanced as well as millions of small ones.
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

/// The size of a segment, as a functor for devices.
template <class Size>
struct SizeOf {
  Size size;
  template <class X>
  RASTRUM_HD std::size_t operator()(const X& x) const {
    return static_cast<std::size_t>(size(x));
  }
};

/// The last index in the ascending `first` whose value is ≤ `value`. Requires first[0] ≤ value.
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

/// The default number of results per chunk; one thread makes them.
template <class Exec>
inline constexpr std::size_t kResultsPerChunk = kBlock;

class ChunkCut {
 public:
  ChunkCut(std::size_t size, std::size_t per_chunk) : size_(size), per_chunk_(per_chunk) {
    assert(per_chunk > 0);
  }
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

/// Where each segment's results lie, and their cut into chunks. `First` is an array of numbers: a
/// backend's buffer, or a view of one.
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
  /// The first result of segment i; first(i) + j is the result of its j.
  [[nodiscard]] RASTRUM_HD std::size_t first(std::size_t i) const { return first_[i]; }
  [[nodiscard]] RASTRUM_HD std::size_t segment_end(std::size_t i) const {
    return i + 1 < first_.size() ? first_[i + 1] : size();
  }
  /// The segment that makes `result`; requires result < size(). O(log n).
  [[nodiscard]] RASTRUM_HD std::size_t segment_of(std::size_t result) const {
    // Empty segments begin where the next one does, so we want the last of them.
    return expand_detail::last_at_most(first_, result);
  }

 private:
  First first_;
};
using Expansion = BasicExpansion<Buffer<std::size_t>>;

/// The expansion for any backend.
template <class Exec, Readable In, class Size>
[[nodiscard]] auto make_expansion(Exec& exec, const In& in, const Size& size,
                                  std::size_t per_chunk = kResultsPerChunk<Exec>) {
  return BasicExpansion<decltype(make_buffer<std::size_t>(exec, 0))>(exec, in, size, per_chunk);
}

/// One chunk, walked in order. Refers to the expansion and its input.
template <class In, class Plan = Expansion>
class ExpansionChunk {
 public:
  RASTRUM_HD ExpansionChunk(const Plan& expansion, const In& in, std::size_t index)
      : expansion_(&expansion), in_(&in), index_(index) {}

  [[nodiscard]] RASTRUM_HD std::size_t index() const { return index_; }
  /// Its results are [begin(), end()).
  [[nodiscard]] RASTRUM_HD std::size_t begin() const { return expansion_->chunk_begin(index_); }
  [[nodiscard]] RASTRUM_HD std::size_t end() const { return expansion_->chunk_end(index_); }
  [[nodiscard]] RASTRUM_HD std::size_t size() const { return end() - begin(); }

  /// Calls f(in[i], j_begin, j_end) for each segment's non-empty share of the chunk.
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

/// Calls f(chunk) for each chunk of the expansion of `in`, in any order, each on one thread: for
/// sinks with something per chunk (a counter in a register, a buffer to flush).
template <class Exec, Readable In, class F>
void expand_chunks(Exec& exec, const Expansion& expansion, const In& in, F&& f) {
  assert(std::size(in) == expansion.segments());
  for_each_index(exec, expansion.chunks(),
                 [&](std::size_t c) { f(ExpansionChunk<In>(expansion, in, c)); });
}

/// Calls f(chunk, in[i], j) for each result, with the chunk's number. One thread makes a chunk's
/// calls, in order.
template <class Exec, Readable In, class F>
void expand_each(Exec& exec, const Expansion& expansion, const In& in, F&& f) {
  expand_chunks(exec, expansion, in, [&](const ExpansionChunk<In>& chunk) {
    chunk.each([&, c = chunk.index()](const auto& element, std::size_t j) { f(c, element, j); });
  });
}

}  // namespace rastrum::parallel
