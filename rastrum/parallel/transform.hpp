// transform: out[i] = f(in[i]), or f(a[i], b[i]).
//
// Work O(n), span O(log n). Allocates nothing. Source: paper 5, appendix A; Futhark's map.
#pragma once

#include <cassert>
#include <cstddef>

#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/tabulate.hpp>

namespace rastrum::parallel {

/// `out` has the size of `in` and may be `in`. f is called once per element, in any order.
template <class Exec, Readable In, Writable Out, class F>
void transform(Exec& exec, const In& in, Out&& out, F&& f) {
  assert(std::size(in) == std::size(out));
  tabulate(exec, out, [&](std::size_t i) { return f(in[i]); });
}

template <class Exec, Readable A, Readable B, Writable Out, class F>
void transform(Exec& exec, const A& a, const B& b, Out&& out, F&& f) {
  assert(std::size(a) == std::size(out) && std::size(b) == std::size(out));
  tabulate(exec, out, [&](std::size_t i) { return f(a[i], b[i]); });
}

}  // namespace rastrum::parallel
