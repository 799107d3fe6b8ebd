// expand_masked_each: an expand_masked that is walked instead of written; for the chunks see
// expand_each. The predicate is asked once per element and remembered as a bit. So the results are
// counted before the first walk, chunks hold equal numbers of them however unevenly they lie, and
// the results of chunk c are those from c · per_chunk on: a sink that writes one thing per result
// needs no counting walk.
//
// Segments of any length: an expansion cuts them into masks of kBits, another one, of the masks'
// ranks, is found again by select (paper 1 has one mask per segment, which bounds it).
//
// Work O(n + Σ size + results), span O(kBlock + per_chunk + log n). Allocates 8 bytes per segment,
// kBits / 8 per mask and 8 for every 4096 elements; nothing per result.
// Source: paper 1, section 3.1.2, and its first future work (section 4.4).
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// Which elements of all segments hold, and how those are cut into chunks.
template <int kBits>
class MaskedExpansion {
 public:
  /// Calls size and holds(in[i], j) once; both must be pure. Requires per_chunk > 0.
  template <class Exec, Readable In, class Size, class Holds>
  MaskedExpansion(Exec& exec, const In& in, Size&& size, Holds&& holds,
                  std::size_t per_chunk = kBlock)
      : cut_(
            exec, in, [&](const auto& x) { return masks_for(size(x)); }, kMasksPerGroup),
        masks_(make_buffer<Mask<kBits>>(exec, cut_.size())),
        before_(make_buffer<std::size_t>(exec, cut_.chunks())),
        per_chunk_(per_chunk) {
    assert(per_chunk > 0);
    expand_chunks(exec, cut_, in, [&](const ExpansionChunk<In>& group) {
      std::size_t m = group.begin(), count = 0;
      group.each_run([&](const auto& x, std::size_t begin, std::size_t end) {
        const auto n = static_cast<std::size_t>(size(x));
        for (std::size_t k = begin; k < end; ++k) {
          const std::size_t first = k * kBits;
          const int width = static_cast<int>(std::min<std::size_t>(kBits, n - first));
          const auto mask = Mask<kBits>::of(
              width, [&](int b) { return holds(x, first + static_cast<std::size_t>(b)); });
          count += static_cast<std::size_t>(mask.rank());
          masks_[m++] = mask;
        }
      });
      before_[group.index()] = count;
    });
    size_ = exclusive_scan(exec, before_, before_, std::size_t{0});
  }

  /// Number of results: elements that hold.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t segments() const { return cut_.segments(); }
  [[nodiscard]] std::size_t per_chunk() const { return per_chunk_; }
  [[nodiscard]] std::size_t chunks() const { return (size_ + per_chunk_ - 1) / per_chunk_; }
  /// Chunk c holds the results [chunk_begin(c), chunk_end(c)).
  [[nodiscard]] std::size_t chunk_begin(std::size_t c) const { return c * per_chunk_; }
  [[nodiscard]] std::size_t chunk_end(std::size_t c) const {
    return std::min(size_, (c + 1) * per_chunk_);
  }

  /// Calls f(in[i], j) for the results [begin, end) in order. O(log n + end − begin + kBlock / 8).
  template <class In, class F>
  void walk(const In& in, std::size_t begin, std::size_t end, F&& f) const {
    if (begin == end) return;
    const auto group = static_cast<std::size_t>(
        std::upper_bound(before_.begin(), before_.end(), begin) - before_.begin() - 1);
    std::size_t m = cut_.chunk_begin(group);
    auto skip = begin - before_[group], left = end - begin;
    for (; skip >= rank(m); ++m) skip -= rank(m);
    for (std::size_t i = cut_.segment_of(m); left > 0; ++i) {
      if (m == cut_.segment_end(i)) continue;
      const auto& element = in[i];
      for (; m < cut_.segment_end(i) && left > 0; ++m) {
        const std::size_t base = (m - cut_.first(i)) * kBits, count = rank(m);
        const auto visit = [&](int b) { f(element, base + static_cast<std::size_t>(b)); };
        const std::size_t stop = std::min(count, skip + left);
        if (stop - skip == count)
          masks_[m].for_each(visit);
        else
          for (std::size_t k = skip; k < stop; ++k) visit(masks_[m].select(static_cast<int>(k)));
        left -= stop - skip;
        skip = 0;
      }
    }
  }

 private:
  /// As many predicates as a block has elements.
  static constexpr std::size_t kMasksPerGroup = kBlock / kBits;
  [[nodiscard]] static std::size_t masks_for(auto size) {
    return (static_cast<std::size_t>(size) + kBits - 1) / kBits;
  }
  [[nodiscard]] std::size_t rank(std::size_t m) const {
    return static_cast<std::size_t>(masks_[m].rank());
  }

  Expansion cut_;  ///< of segments into masks; its chunks are the groups
  Buffer<Mask<kBits>> masks_;
  Buffer<std::size_t> before_;  ///< results before each group
  std::size_t size_ = 0, per_chunk_;
};

/// One chunk of a masked expansion, to be walked in order. Borrows the expansion and its input.
template <int kBits, class In>
class MaskedChunk {
 public:
  MaskedChunk(const MaskedExpansion<kBits>& expansion, const In& in, std::size_t index)
      : expansion_(&expansion), in_(&in), index_(index) {}

  [[nodiscard]] std::size_t index() const { return index_; }
  /// The results it holds: begin() is the number of the first one.
  [[nodiscard]] std::size_t begin() const { return expansion_->chunk_begin(index_); }
  [[nodiscard]] std::size_t end() const { return expansion_->chunk_end(index_); }
  [[nodiscard]] std::size_t size() const { return end() - begin(); }

  /// Calls f(in[i], j) for each result of the chunk.
  template <class F>
  void each(F&& f) const {
    expansion_->walk(*in_, begin(), end(), f);
  }

 private:
  const MaskedExpansion<kBits>* expansion_;
  const In* in_;
  std::size_t index_;
};

/// Calls f(chunk) for each chunk of an expansion of `in`, each by one thread, in any order.
template <class Exec, int kBits, Readable In, class F>
void expand_chunks(Exec& exec, const MaskedExpansion<kBits>& expansion, const In& in, F&& f) {
  assert(std::size(in) == expansion.segments());
  for_each_index(exec, expansion.chunks(),
                 [&](std::size_t c) { f(MaskedChunk<kBits, In>(expansion, in, c)); });
}

/// Calls f(chunk, in[i], j) for each result, in order within a chunk.
template <class Exec, int kBits, Readable In, class F>
void expand_masked_each(Exec& exec, const MaskedExpansion<kBits>& expansion, const In& in, F&& f) {
  expand_chunks(exec, expansion, in, [&](const MaskedChunk<kBits, In>& chunk) {
    chunk.each([&, c = chunk.index()](const auto& element, std::size_t j) { f(c, element, j); });
  });
}

/// The same for an expansion that is walked once.
template <int kBits = 64, class Exec, Readable In, class Size, class Holds, class F>
void expand_masked_each(Exec& exec, const In& in, Size&& size, Holds&& holds, F&& f) {
  expand_masked_each(exec, MaskedExpansion<kBits>(exec, in, size, holds), in, f);
}

}  // namespace rastrum::parallel
