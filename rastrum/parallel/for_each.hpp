// SPDX-License-Identifier: BSD-3-Clause
// for_each: f(range[i]) for all elements, for what f does to them.
//
// Work O(n), span O(kBlock + log n). Allocates nothing. For the indices themselves see
// for_each_index (exec.hpp).
#pragma once

#include <cstddef>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// f is called once per element, in any order; it gets what range[i] is, a reference as a rule.
template <class Exec, Readable Range, class F>
void for_each(Exec& exec, Range&& range, F&& f) {
  for_each_block(exec, std::size(range), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(range[i]);
  });
}

}  // namespace rastrum::parallel
