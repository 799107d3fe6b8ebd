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

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/transform.hpp>

namespace rastrum::parallel {

/// Where the results of each segment lie, and how they are cut into chunks.
class Expansion {
 public:
  /// Calls size(in[i]) → integer ≥ 0 once per segment. Requires per_chunk > 0.
  template <class Exec, Readable In, class Size>
  Expansion(Exec& exec, const In& in, Size&& size, std::size_t per_chunk = kBlock)
      : first_(make_buffer<std::size_t>(exec, std::size(in))), per_chunk_(per_chunk) {
    assert(per_chunk > 0);
    transform(exec, in, first_, [&](const auto& x) { return static_cast<std::size_t>(size(x)); });
    size_ = exclusive_scan(exec, first_, first_, std::size_t{0});
  }

  /// Number of results.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t segments() const { return first_.size(); }
  /// The result with which segment i begins: first(i) + j is made from its j.
  [[nodiscard]] std::size_t first(std::size_t i) const { return first_[i]; }
  [[nodiscard]] std::size_t segment_end(std::size_t i) const {
    return i + 1 < first_.size() ? first_[i + 1] : size_;
  }
  /// The segment that makes `result`; requires result < size(). O(log n).
  [[nodiscard]] std::size_t segment_of(std::size_t result) const {
    // Empty segments begin where the next one does: the last of them is meant.
    return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), result) -
                                    first_.begin() - 1);
  }

  [[nodiscard]] std::size_t per_chunk() const { return per_chunk_; }
  [[nodiscard]] std::size_t chunks() const { return (size_ + per_chunk_ - 1) / per_chunk_; }
  /// Chunk c holds the results [chunk_begin(c), chunk_end(c)).
  [[nodiscard]] std::size_t chunk_begin(std::size_t c) const { return c * per_chunk_; }
  [[nodiscard]] std::size_t chunk_end(std::size_t c) const {
    return std::min(size_, (c + 1) * per_chunk_);
  }

 private:
  Buffer<std::size_t> first_;
  std::size_t size_ = 0, per_chunk_;
};

/// One chunk of an expansion, to be walked in order. Borrows the expansion and its input.
template <class In>
class ExpansionChunk {
 public:
  ExpansionChunk(const Expansion& expansion, const In& in, std::size_t index)
      : expansion_(&expansion), in_(&in), index_(index) {}

  [[nodiscard]] std::size_t index() const { return index_; }
  /// The results it holds: begin() is the number of the first one.
  [[nodiscard]] std::size_t begin() const { return expansion_->chunk_begin(index_); }
  [[nodiscard]] std::size_t end() const { return expansion_->chunk_end(index_); }
  [[nodiscard]] std::size_t size() const { return end() - begin(); }

  /// Calls f(in[i], j_begin, j_end) for each segment's share of the chunk, which is not empty: for
  /// sinks that have something to do once per segment.
  template <class F>
  void each_run(F&& f) const {
    const std::size_t stop = end();
    std::size_t i = expansion_->segment_of(begin());
    for (std::size_t k = begin(); k < stop; ++i) {
      const std::size_t run_end = std::min(stop, expansion_->segment_end(i));
      if (k == run_end) continue;
      const std::size_t first = expansion_->first(i);
      f((*in_)[i], k - first, run_end - first);
      k = run_end;
    }
  }
  /// Calls f(in[i], j) for each result of the chunk.
  template <class F>
  void each(F&& f) const {
    each_run([&](const auto& element, std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) f(element, j);
    });
  }

 private:
  const Expansion* expansion_;
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

/// The same for an expansion that is walked once.
template <class Exec, Readable In, class Size, class F>
void expand_each(Exec& exec, const In& in, Size&& size, F&& f) {
  expand_each(exec, Expansion(exec, in, size), in, f);
}

}  // namespace rastrum::parallel
