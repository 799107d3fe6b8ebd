// SPDX-License-Identifier: BSD-3-Clause
// transform: out[i] = f(in[i]).
//
// Work O(n), span O(log n). Allocates nothing. Source: paper 5, appendix A; Futhark's map.
#pragma once

#include <cassert>
#include <cstddef>

#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/tabulate.hpp>

namespace rastrum::parallel {

/// `out` has the size of `in` and may be `in`. Calls f once per element, in any order.
template <class Exec, Readable In, Writable Out, class F>
void transform(Exec& exec, const In& in, Out&& out, F&& f) {
  assert(std::size(in) == std::size(out));
  tabulate(exec, out, [&](std::size_t i) { return f(in[i]); });
}

}  // namespace rastrum::parallel
