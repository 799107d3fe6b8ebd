// SPDX-License-Identifier: BSD-3-Clause
// partition: the elements for which a predicate holds, then the others, each in their order.
//
// Work O(n), span O(kBlock). Allocates the result; threads n / 8 bytes more.
// Source: paper 1, section 3.1.3 (small and large triangles).
#pragma once

#include <cstddef>

#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/selection.hpp>

namespace rastrum::parallel {

template <class T>
struct Partition {
  Buffer<T> elements;
  std::size_t first_count = 0;  ///< the number of elements for which the predicate holds
};

/// Calls the predicate once per element.
template <Readable In, class Predicate>
[[nodiscard]] Partition<element_t<In>> partition(Serial& exec, const In& in, Predicate&& holds) {
  Partition<element_t<In>> out{make_buffer<element_t<In>>(exec)};
  auto others = make_buffer<element_t<In>>(exec);
  for (std::size_t i = 0; i < std::size(in); ++i)
    (holds(in[i]) ? out.elements : others).push_back(in[i]);
  out.first_count = out.elements.size();
  out.elements.insert(out.elements.end(), others.begin(), others.end());
  return out;
}

template <Readable In, class Predicate>
[[nodiscard]] Partition<element_t<In>> partition(Threads& exec, const In& in, Predicate&& holds) {
  const Selection selected = select_elements(exec, in, holds);
  Partition<element_t<In>> out{make_buffer<element_t<In>>(exec, std::size(in)), selected.count};
  for_each_block(exec, std::size(in), [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::size_t first = selected.before[block];
    std::size_t other = selected.count + (begin - first);
    for (std::size_t i = begin; i < end; ++i)
      out.elements[selected.test(i) ? first++ : other++] = in[i];
  });
  return out;
}

}  // namespace rastrum::parallel
