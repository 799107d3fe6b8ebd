// SPDX-License-Identifier: BSD-3-Clause
// reduce: in[0] op in[1] op … op in[n − 1].
//
// The operator must be associative; it need not commute. Even if it is so only up to rounding, the
// result depends neither on the backend nor on the threads: each block of kBlock elements is folded
// from the left, then the blocks' results are. Work O(n), span O(kBlock + n / kBlock). Threads
// allocate one T per block. Source: Blelloch's primitives as in paper 1, section 2.2.2.
#pragma once

#include <cstddef>
#include <functional>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>

namespace rastrum::parallel {

/// in[begin] op … op in[end − 1] from the left, in T. Requires begin < end.
template <class T, Readable In, class Op>
[[nodiscard]] RASTRUM_HD T fold_block(const In& in, std::size_t begin, std::size_t end, Op& op) {
  T sum = static_cast<T>(in[begin]);
  for (std::size_t i = begin + 1; i < end; ++i)
    sum = static_cast<T>(op(sum, static_cast<T>(in[i])));
  return sum;
}

/// `initial`, usually the neutral element, comes first. Elements are converted to its type.
template <Readable In, class T, class Op = std::plus<>>
[[nodiscard]] T reduce(Serial& exec, const In& in, T initial, Op op = {}) {
  for_each_block(exec, std::size(in), [&](std::size_t, std::size_t begin, std::size_t end) {
    initial = static_cast<T>(op(initial, fold_block<T>(in, begin, end, op)));
  });
  return initial;
}

template <Readable In, class T, class Op = std::plus<>>
[[nodiscard]] T reduce(Threads& exec, const In& in, T initial, Op op = {}) {
  auto partial = make_buffer<T>(exec, block_count(std::size(in)));
  for_each_block(exec, std::size(in), [&](std::size_t block, std::size_t begin, std::size_t end) {
    partial[block] = fold_block<T>(in, begin, end, op);
  });
  for (const T& p : partial) initial = static_cast<T>(op(initial, p));
  return initial;
}

}  // namespace rastrum::parallel
