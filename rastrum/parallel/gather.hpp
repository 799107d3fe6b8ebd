// gather: out[i] = in[map[i]].
//
// Work O(n), span O(log n). Allocates nothing. Source: paper 5, appendix A.
#pragma once

#include <cassert>
#include <cstddef>

#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/tabulate.hpp>

namespace rastrum::parallel {

/// `out` has the size of `map`, every index of which is < size(in). `out` must not overlap `in`.
template <class Exec, Readable In, Readable Map, Writable Out>
void gather(Exec& exec, const In& in, const Map& map, Out&& out) {
  assert(std::size(map) == std::size(out));
  tabulate(exec, out, [&](std::size_t i) -> decltype(auto) {
    const auto from = static_cast<std::size_t>(map[i]);
    assert(from < std::size(in));
    return in[from];
  });
}

}  // namespace rastrum::parallel
