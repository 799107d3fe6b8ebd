// SPDX-License-Identifier: BSD-3-Clause
// tabulate: out[i] = f(i).
//
// Work O(n), span O(log n). Allocates nothing. Source: Futhark's tabulate (paper 1, section 2.2.2);
// transform over counting(n) in paper 5, appendix A.
#pragma once

#include <cstddef>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// Calls f once for each index of `out`, in any order.
template <Writable Out, class F>
void tabulate(Serial&, Out&& out, F&& f) {
  const std::size_t n = std::size(out);
  for (std::size_t i = 0; i < n; ++i) out[i] = f(i);
}

template <Writable Out, class F>
void tabulate(Threads& exec, Out&& out, F&& f) {
  for_each_block(exec, std::size(out), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = f(i);
  });
}

}  // namespace rastrum::parallel
