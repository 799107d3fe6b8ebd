// SPDX-License-Identifier: BSD-3-Clause
// expand: flattens segments. Element i stands for size(in[i]) results, which are get(in[i], j) for
// j in [0, size(in[i])), segment after segment.
//
// Work O(n + total), span O(kBlock + log n). Threads cut the result, not the segments
// (expand_each.hpp). Paper 5 fills the gaps with a maximum scan instead. Allocates the result and,
// with threads, 8 bytes per segment. Source: paper 1, section 2.2.2; paper 5, appendix A, algorithm
// 1.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

template <class In, class Get>
using expanded_t = std::remove_cvref_t<
    std::invoke_result_t<Get&, decltype(std::declval<const In&>()[0]), std::size_t>>;

/// Calls size(in[i]) → integer ≥ 0 once per segment and get(in[i], j) once per result; both must be
/// pure.
template <Readable In, class Size, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand(Serial& exec, const In& in, Size&& size,
                                                 Get&& get) {
  auto out = make_buffer<expanded_t<In, Get>>(exec);
  for (std::size_t i = 0; i < std::size(in); ++i) {
    const auto n = static_cast<std::size_t>(size(in[i]));
    for (std::size_t j = 0; j < n; ++j) out.push_back(get(in[i], j));
  }
  return out;
}

template <Readable In, class Size, class Get>
[[nodiscard]] Buffer<expanded_t<In, Get>> expand(Threads& exec, const In& in, Size&& size,
                                                 Get&& get) {
  const Expansion expansion(exec, in, size);
  auto out = make_buffer<expanded_t<In, Get>>(exec, expansion.size());
  expand_chunks(exec, expansion, in, [&](const ExpansionChunk<In>& chunk) {
    std::size_t k = chunk.begin();
    chunk.each([&](const auto& element, std::size_t j) { out[k++] = get(element, j); });
  });
  return out;
}

}  // namespace rastrum::parallel
