// index_in_group: which element of its group each element is, where groups lie one after another.
//
// Work O(n), span O(log n). Allocates nothing. Source: paper 5, appendix A, algorithm 2
// (indexInSubGroup).
#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>

#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/tabulate.hpp>

namespace rastrum::parallel {

/// out[i] = i − first[group[i]]: `group` names each element's group (see `owners`), `first` where
/// each group begins. The sizes of `out` and `group` agree.
template <class Exec, Readable Group, Readable First, Writable Out>
void index_in_group(Exec& exec, const Group& group, const First& first, Out&& out) {
  assert(std::size(group) == std::size(out));
  using Index = std::remove_cvref_t<decltype(out[0])>;
  tabulate(exec, out, [&](std::size_t i) {
    return static_cast<Index>(i -
                              static_cast<std::size_t>(first[static_cast<std::size_t>(group[i])]));
  });
}

}  // namespace rastrum::parallel
