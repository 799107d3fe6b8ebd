// expand_masked: an expansion that leaves out the elements for which a predicate does not hold,
// without ever writing them: get(in[i], j) for those j in [0, size(in[i])) with holds(in[i], j).
//
// A first pass records the predicate in bit masks, their ranks are the sizes of a second expansion,
// and select finds again which element is meant. The paper's masks bound a segment to their width;
// here longer segments are cut into chunks of kBits by an expansion of their own.
//
// Work O(n + Σ size + result · log kBits), span O(kBlock · kBits + log n). Allocates the result
// and, with threads, 24 + kBits / 8 bytes per chunk. The paper measured no gain in masks beyond 64
// bits. Source: paper 1, section 3.1.2.
#pragma once

#include <algorithm>
#include <cstddef>

#include <rastrum/parallel/expand.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// Calls size and holds, which must be pure, and get once per element of the result.
template <int kBits = 64, Readable In, class Size, class Holds, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand_masked(Serial&, const In& in, Size&& size,
                                                        Holds&& holds, Get&& get) {
  Buffer<expanded_t<In, Get>> out;
  for (std::size_t i = 0; i < std::size(in); ++i) {
    const auto n = static_cast<std::size_t>(size(in[i]));
    for (std::size_t j = 0; j < n; ++j)
      if (holds(in[i], j)) out.push_back(get(in[i], j));
  }
  return out;
}

template <int kBits = 64, Readable In, class Size, class Holds, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand_masked(Threads& exec, const In& in, Size&& size,
                                                        Holds&& holds, Get&& get) {
  struct Chunk {
    std::size_t segment = 0, first = 0;  ///< elements first … first + kBits − 1 of the segment
  };
  const Buffer<Chunk> chunks = expand(
      exec, counting(std::size(in)),
      [&](std::size_t i) { return (static_cast<std::size_t>(size(in[i])) + kBits - 1) / kBits; },
      [](std::size_t i, std::size_t c) {
        return Chunk{i, c * kBits};
      });

  Buffer<Mask<kBits>> masks(chunks.size());
  transform(exec, chunks, masks, [&](const Chunk& chunk) {
    const auto& segment = in[chunk.segment];
    const std::size_t rest = static_cast<std::size_t>(size(segment)) - chunk.first;
    const int n = static_cast<int>(std::min<std::size_t>(kBits, rest));
    Mask<kBits> mask;
    for (int j = 0; j < n; ++j)
      if (holds(segment, chunk.first + static_cast<std::size_t>(j))) mask.set(j);
    return mask;
  });

  return expand(
      exec, counting(chunks.size()), [&](std::size_t c) { return masks[c].rank(); },
      [&](std::size_t c, std::size_t k) {
        const int j = masks[c].select(static_cast<int>(k));
        return get(in[chunks[c].segment], chunks[c].first + static_cast<std::size_t>(j));
      });
}

}  // namespace rastrum::parallel
