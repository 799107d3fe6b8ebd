// unique: the first element of each run of equal neighbours. Sort first where all equals are to
// meet.
//
// Work O(n), span O(kBlock). Allocates the result and, with threads, n / 8 bytes and 8 per element
// of it. Source: DESIGN section 5; the keys of reduce_by_key without its values.
#pragma once

#include <cstddef>
#include <functional>

#include <rastrum/parallel/filter.hpp>
#include <rastrum/parallel/gather.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// equal(a, b) for neighbours a, b; it must be an equivalence.
template <class Exec, Readable In, class Equal = std::equal_to<>>
[[nodiscard]] Buffer<element_t<In>> unique(Exec& exec, const In& in, Equal equal = {}) {
  const auto heads = filter(exec, counting(std::size(in)),
                            [&](std::size_t i) { return i == 0 || !equal(in[i - 1], in[i]); });
  auto out = make_buffer<element_t<In>>(exec, heads.size());
  gather(exec, in, heads, out);
  return out;
}

}  // namespace rastrum::parallel
