// SPDX-License-Identifier: BSD-3-Clause
// scatter: out[map[i]] = in[i]; scatter_if only where stencil[i] is true.
//
// Futhark's scatter ignores indices outside of `out` (paper 1, section 2.2.3). Here they are a bug
// of the caller; a stencil leaves elements out (paper 5, appendix A). Work O(n), span O(log n).
// Allocates nothing.
#pragma once

#include <cassert>
#include <cstddef>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// Requires: the map[i] whose stencil is true are < size(out) and all different, since two writers
/// of one element are a race. The rest of `out` is unchanged. `out` must not overlap the inputs.
template <class Exec, Readable In, Readable Map, Readable Stencil, Writable Out>
void scatter_if(Exec& exec, const In& in, const Map& map, const Stencil& stencil, Out&& out) {
  assert(std::size(in) == std::size(map) && std::size(in) == std::size(stencil));
  for_each_block(exec, std::size(in), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!static_cast<bool>(stencil[i])) continue;
      const auto to = static_cast<std::size_t>(map[i]);
      assert(to < std::size(out));
      out[to] = in[i];
    }
  });
}

template <class Exec, Readable In, Readable Map, Writable Out>
void scatter(Exec& exec, const In& in, const Map& map, Out&& out) {
  scatter_if(exec, in, map, constant(std::size(in), true), out);
}

}  // namespace rastrum::parallel
