// SPDX-License-Identifier: BSD-3-Clause
// for_each: calls f(range[i]) for all elements, for its side effects.
//
// Work O(n), span O(kBlock + log n). Allocates nothing. For indices see for_each_index (exec.hpp).
#pragma once

#include <cstddef>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// Calls f once per element, in any order.
template <class Exec, Readable Range, class F>
void for_each(Exec& exec, Range&& range, F&& f) {
  for_each_block(exec, std::size(range), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(range[i]);
  });
}

}  // namespace rastrum::parallel
