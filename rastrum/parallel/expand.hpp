// expand: flattens segments. Element i stands for a segment of size(in[i]) elements, and the result
// is get(in[i], j) for all j in [0, size(in[i])), segment after segment.
//
// Work O(n + total), span O(kBlock + log n): the threads cut the result, not the segments, into
// blocks, and a block finds its first segment by binary search; so one huge segment and millions of
// small ones are divided alike. Paper 5 fills the gaps with a maximum scan instead.
// Allocates the result and, with threads, 8 bytes per segment.
// Source: paper 1, section 2.2.2; `owners` is the expand of paper 5, appendix A, algorithm 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/transform.hpp>

namespace rastrum::parallel {

template <class In, class Get>
using expanded_t = std::remove_cvref_t<
    std::invoke_result_t<Get&, decltype(std::declval<const In&>()[0]), std::size_t>>;

/// Calls size(in[i]) → integer ≥ 0 once per segment and get(in[i], j) once per element of the
/// result; both must be pure.
template <Readable In, class Size, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand(Serial&, const In& in, Size&& size, Get&& get) {
  Buffer<expanded_t<In, Get>> out;
  for (std::size_t i = 0; i < std::size(in); ++i) {
    const auto n = static_cast<std::size_t>(size(in[i]));
    for (std::size_t j = 0; j < n; ++j) out.push_back(get(in[i], j));
  }
  return out;
}

template <Readable In, class Size, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand(Threads& exec, const In& in, Size&& size,
                                                 Get&& get) {
  Buffer<std::size_t> first(std::size(in));
  transform(exec, in, first, [&](const auto& x) { return static_cast<std::size_t>(size(x)); });
  const std::size_t total = exclusive_scan(exec, first, first, std::size_t{0});
  Buffer<expanded_t<In, Get>> out(total);
  for_each_block(exec, total, [&](std::size_t, std::size_t begin, std::size_t end) {
    // The last segment that begins at or before `begin`; empty ones begin where the next one does.
    std::size_t i = static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), begin) -
                                             first.begin() - 1);
    for (std::size_t k = begin; k < end; ++i) {
      const std::size_t stop = i + 1 < first.size() ? std::min(end, first[i + 1]) : end;
      for (; k < stop; ++k) out[k] = get(in[i], k - first[i]);
    }
  });
  return out;
}

/// Each index i of `counts`, counts[i] times: to which segment the elements of an expansion belong.
template <class Exec, Readable Counts>
[[nodiscard]] Buffer<std::uint32_t> owners(Exec& exec, const Counts& counts) {
  return expand(
      exec, counting<std::uint32_t>(std::size(counts)), [&](std::uint32_t i) { return counts[i]; },
      [](std::uint32_t i, std::size_t) { return i; });
}

}  // namespace rastrum::parallel
