// SPDX-License-Identifier: BSD-3-Clause
// filter: the elements for which a predicate holds, in their order.
//
// Work O(n), span O(kBlock). Allocates the result; threads n / 8 bytes more.
// Source: Futhark's filter (paper 1, section 2.2.2); also known as compaction.
#pragma once

#include <cstddef>

#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/selection.hpp>

namespace rastrum::parallel {

/// Calls the predicate once per element. For indices use filter(exec, counting(n), predicate of the
/// index).
template <Readable In, class Predicate>
[[nodiscard]] Buffer<element_t<In>> filter(Serial& exec, const In& in, Predicate&& holds) {
  auto out = make_buffer<element_t<In>>(exec);
  for (std::size_t i = 0; i < std::size(in); ++i)
    if (holds(in[i])) out.push_back(in[i]);
  return out;
}

template <Readable In, class Predicate>
[[nodiscard]] Buffer<element_t<In>> filter(Threads& exec, const In& in, Predicate&& holds) {
  const Selection selected = select_elements(exec, in, holds);
  auto out = make_buffer<element_t<In>>(exec, selected.count);
  for_each_block(exec, std::size(in), [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::size_t to = selected.before[block];
    for (std::size_t i = begin; i < end; i += 64)
      for (std::uint64_t word = selected.words[i / 64]; word != 0; word &= word - 1)
        out[to++] = in[i + static_cast<std::size_t>(lowest_bit(word))];
  });
  return out;
}

}  // namespace rastrum::parallel
