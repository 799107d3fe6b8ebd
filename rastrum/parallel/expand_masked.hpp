// SPDX-License-Identifier: BSD-3-Clause
// expand_masked: expand, but only the results for which holds(in[i], j).
//
// A first pass records the predicate in bit masks, whose ranks count the results. A second pass
// walks the set bits (masked_expansion.hpp).
//
// Work O(n + Σ size + result), span O(kBlock + log n). Allocates the result and, with threads, 8
// bytes per segment, kBits / 8 per mask and 8 for every 4096 elements. The default of 64 bits is
// measured (docs/log/words.md).
// Source: paper 1, section 3.1.2.
#pragma once

#include <cstddef>

#include <rastrum/parallel/expand.hpp>
#include <rastrum/parallel/masked_expansion.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// Calls size and holds, which must be pure, and calls get once per result.
template <int kBits = 64, Readable In, class Size, class Holds, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand_masked(Serial& exec, const In& in, Size&& size,
                                                        Holds&& holds, Get&& get) {
  auto out = make_buffer<expanded_t<In, Get>>(exec);
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
  const MaskedExpansion<kBits> expansion(exec, in, size, holds);
  auto out = make_buffer<expanded_t<In, Get>>(exec, expansion.size());
  expand_chunks(exec, expansion, in, [&](const MaskedChunk<kBits, In>& chunk) {
    std::size_t k = chunk.begin();
    chunk.each([&](const auto& element, std::size_t j) { out[k++] = get(element, j); });
  });
  return out;
}

}  // namespace rastrum::parallel
