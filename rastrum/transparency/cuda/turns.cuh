// SPDX-License-Identifier: BSD-3-Clause
// Runs of neighbouring bins, as long as their items fit a budget together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/parallel/cuda/elementwise.cuh>
#include <rastrum/parallel/expand_each.hpp>

namespace rastrum::transparency::cuda {

struct Turn {
  std::size_t begin = 0, end = 0;  ///< bins
  std::uint64_t first = 0;         ///< of the first bin
  std::uint64_t items = 0;
};

struct EndOfTurn {
  std::span<const std::uint64_t> first;
  std::size_t begin;
  std::uint64_t most;
  RASTRUM_HD std::uint64_t operator()(std::size_t what) const {
    // The last of equal places, so that empty bins take no turns.
    std::size_t end =
        begin + parallel::expand_detail::last_at_most(first.subspan(begin), first[begin] + most);
    if (end == begin) ++end;
    return what == 0 ? end : first[end];
  }
};

/// Sets the next turn, or returns false if none is left. Bin b has the items [first[b], first[b +
/// 1]); the last element of `first` is `all`. A turn has at most `most` items, or one bin. Waits if
/// there are several turns.
inline bool next_turn(parallel::Cuda& exec, std::span<const std::uint64_t> first, std::uint64_t all,
                      std::uint64_t most, Turn& turn) {
  const std::size_t bins = first.size() - 1;
  const std::uint64_t begin_item = turn.first + turn.items;
  if (turn.end == bins || begin_item == all) return false;
  turn.begin = turn.end;
  turn.first = begin_item;
  if (all - begin_item <= most) {
    turn.end = bins;
    turn.items = all - begin_item;
    return true;
  }
  auto end = parallel::make_buffer<std::uint64_t>(exec, 2);
  parallel::tabulate(exec, end, EndOfTurn{first, turn.begin, most});
  const auto found = parallel::to_host(exec, end);
  turn.end = static_cast<std::size_t>(found[0]);
  turn.items = found[1] - begin_item;
  return true;
}

}  // namespace rastrum::transparency::cuda
