// SPDX-License-Identifier: BSD-3-Clause
// A masked expansion: expand_masked, walked by chunks as in expand_each instead of written. The
// predicate runs once per element and is kept as a bit. So results are counted before the first
// walk, all chunks hold equally many, and chunk c begins with result c · per_chunk: a sink with one
// output per result needs no counting walk.
//
// Segments have any length: an expansion cuts them into masks of kBits. (Paper 1 has one mask per
// segment, which bounds its length.)
//
// Work O(n + Σ size + results), span O(kBlock + per_chunk + log n). Allocates 8 bytes per segment,
// kBits / 8 per mask and 8 for every 4096 elements; nothing per result.
// Source: paper 1, section 3.1.2, and its first future work (section 4.4).
#pragma once

#include <cassert>
#include <cstddef>
#include <span>

#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

namespace masked_detail {

template <int kBits, class Size>
struct MasksFor {
  Size size;
  template <class X>
  RASTRUM_HD std::size_t operator()(const X& x) const {
    return (static_cast<std::size_t>(size(x)) + kBits - 1) / kBits;
  }
};

/// Fills the masks of a group from the predicate and counts the set bits.
template <int kBits, class Size, class Holds>
struct FillMasks {
  Size size;
  Holds holds;
  std::span<Mask<kBits>> masks;
  std::span<std::size_t> counts;  ///< one for each group
  template <class Chunk>
  RASTRUM_HD void operator()(const Chunk& group) const {
    std::size_t m = group.begin(), count = 0;
    group.each_run([&](const auto& x, std::size_t begin, std::size_t end) {
      const auto n = static_cast<std::size_t>(size(x));
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t first = k * kBits, rest = n - first;
        const int width = rest < kBits ? static_cast<int>(rest) : kBits;
        const auto mask = Mask<kBits>::of(
            width, [&](int b) { return holds(x, first + static_cast<std::size_t>(b)); });
        count += static_cast<std::size_t>(mask.rank());
        masks[m++] = mask;
      }
    });
    counts[group.index()] = count;
  }
};

}  // namespace masked_detail

/// Elements whose predicate one thread asks.
template <class Exec>
inline constexpr std::size_t kElementsPerGroup = kBlock;

/// The elements for which the predicate holds, and their cut into chunks. `Masks` and `Numbers` are
/// a backend's buffers, or views of them.
template <int kBits, class Masks, class Numbers>
class BasicMaskedExpansion : public ChunkCut {
 public:
  /// Calls size, and once for each element holds(in[i], j); both must be pure. Requires per_chunk >
  /// 0.
  template <class Exec, Readable In, class Size, class Holds>
  BasicMaskedExpansion(Exec& exec, const In& in, const Size& size, const Holds& holds,
                       std::size_t per_chunk = kResultsPerChunk<Exec>)
      : ChunkCut(0, per_chunk),
        cut_(exec, in, masked_detail::MasksFor<kBits, Size>{size},
             (kElementsPerGroup<Exec> + kBits - 1) / kBits),
        masks_(make_buffer<Mask<kBits>>(exec, cut_.size())),
        before_(make_buffer<std::size_t>(exec, cut_.chunks())) {
    expand_chunks(exec, cut_, in,
                  masked_detail::FillMasks<kBits, Size, Holds>{size, holds, view_of(masks_),
                                                               view_of(before_)});
    set_size(exclusive_scan(exec, before_, before_, std::size_t{0}));
  }
  BasicMaskedExpansion(BasicExpansion<Numbers> masks_cut, Masks masks, Numbers before,
                       const ChunkCut& cut)
      : ChunkCut(cut), cut_(masks_cut), masks_(masks), before_(before) {}

  /// The form that kernels take; must not outlive this.
  [[nodiscard]] auto view() const {
    using MaskView = std::span<const Mask<kBits>>;
    using NumberView = std::span<const std::size_t>;
    return BasicMaskedExpansion<kBits, MaskView, NumberView>(
        cut_.view(), MaskView(masks_.data(), masks_.size()),
        NumberView(before_.data(), before_.size()), *this);
  }

  [[nodiscard]] RASTRUM_HD std::size_t segments() const { return cut_.segments(); }

  /// Calls f(in[i], j) for the results [begin, end) in order. O(log n + end − begin + kBlock / 8).
  template <class In, class F>
  RASTRUM_HD void walk(const In& in, std::size_t begin, std::size_t end, F&& f) const {
    if (begin == end) return;
    const std::size_t group = expand_detail::last_at_most(before_, begin);
    std::size_t m = cut_.chunk_begin(group);
    auto skip = begin - before_[group], left = end - begin;
    for (; skip >= rank(m); ++m) skip -= rank(m);
    for (std::size_t i = cut_.segment_of(m); left > 0; ++i) {
      if (m == cut_.segment_end(i)) continue;
      const auto& element = in[i];
      for (; m < cut_.segment_end(i) && left > 0; ++m) {
        const std::size_t base = (m - cut_.first(i)) * kBits, count = rank(m);
        const auto visit = [&](int b) { f(element, base + static_cast<std::size_t>(b)); };
        const std::size_t stop = skip + left < count ? skip + left : count;
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
  [[nodiscard]] RASTRUM_HD std::size_t rank(std::size_t m) const {
    return static_cast<std::size_t>(masks_[m].rank());
  }

  BasicExpansion<Numbers> cut_;  ///< of segments into masks; its chunks are the groups
  Masks masks_;
  Numbers before_;  ///< results before each group
};
template <int kBits>
using MaskedExpansion = BasicMaskedExpansion<kBits, Buffer<Mask<kBits>>, Buffer<std::size_t>>;

/// The masked expansion for any backend.
template <int kBits = 64, class Exec, Readable In, class Size, class Holds>
[[nodiscard]] auto make_masked_expansion(Exec& exec, const In& in, const Size& size,
                                         const Holds& holds,
                                         std::size_t per_chunk = kResultsPerChunk<Exec>) {
  return BasicMaskedExpansion<kBits, decltype(make_buffer<Mask<kBits>>(exec, 0)),
                              decltype(make_buffer<std::size_t>(exec, 0))>(exec, in, size, holds,
                                                                           per_chunk);
}

/// As ExpansionChunk.
template <int kBits, class In, class Plan = MaskedExpansion<kBits>>
class MaskedChunk {
 public:
  RASTRUM_HD MaskedChunk(const Plan& expansion, const In& in, std::size_t index)
      : expansion_(&expansion), in_(&in), index_(index) {}

  [[nodiscard]] RASTRUM_HD std::size_t index() const { return index_; }
  /// The number of the first result that it holds.
  [[nodiscard]] RASTRUM_HD std::size_t begin() const { return expansion_->chunk_begin(index_); }
  [[nodiscard]] RASTRUM_HD std::size_t end() const { return expansion_->chunk_end(index_); }
  [[nodiscard]] RASTRUM_HD std::size_t size() const { return end() - begin(); }

  template <class F>
  RASTRUM_HD void each(F&& f) const {
    expansion_->walk(*in_, begin(), end(), f);
  }

 private:
  const Plan* expansion_;
  const In* in_;
  std::size_t index_;
};

/// As for an expansion without masks.
template <class Exec, int kBits, Readable In, class F>
void expand_chunks(Exec& exec, const MaskedExpansion<kBits>& expansion, const In& in, F&& f) {
  assert(std::size(in) == expansion.segments());
  for_each_index(exec, expansion.chunks(),
                 [&](std::size_t c) { f(MaskedChunk<kBits, In>(expansion, in, c)); });
}

}  // namespace rastrum::parallel
