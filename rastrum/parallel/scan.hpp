// SPDX-License-Identifier: BSD-3-Clause
// exclusive_scan: out[i] = in[0] op … op in[i − 1]; inclusive_scan: … op in[i].
//
// The operator must be associative. The result is as deterministic as reduce's: within a block of
// kBlock elements the sums run from its first element, and the sum of all earlier blocks comes
// before them. Work O(n) (threads read the input twice), span O(kBlock + n / kBlock). Threads
// allocate one T per block. Source: Blelloch, "Prefix sums and their applications", 1990; paper 5,
// appendix A.
#pragma once

#include <cassert>
#include <cstddef>
#include <functional>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/reduce.hpp>

namespace rastrum::parallel {
namespace scan_detail {

/// Writes one block, where `carry` is the sum of all before it; returns the sum including it.
template <bool kInclusive, class In, class Out, class T, class Op>
RASTRUM_HD T scan_block(const In& in, Out& out, std::size_t begin, std::size_t end, T carry,
                        Op& op) {
  T local = static_cast<T>(in[begin]);  // before the write: `out` may be `in`
  if constexpr (!kInclusive) out[begin] = carry;
  if constexpr (kInclusive) out[begin] = static_cast<T>(op(carry, local));
  for (std::size_t i = begin + 1; i < end; ++i) {
    const T value = static_cast<T>(in[i]);
    if constexpr (!kInclusive) out[i] = static_cast<T>(op(carry, local));
    local = static_cast<T>(op(local, value));
    if constexpr (kInclusive) out[i] = static_cast<T>(op(carry, local));
  }
  return static_cast<T>(op(carry, local));
}

template <bool kInclusive, class In, class Out, class T, class Op>
T scan(Serial& exec, const In& in, Out& out, T carry, Op& op) {
  for_each_block(exec, std::size(in), [&](std::size_t, std::size_t begin, std::size_t end) {
    carry = scan_block<kInclusive>(in, out, begin, end, carry, op);
  });
  return carry;
}

template <bool kInclusive, class In, class Out, class T, class Op>
T scan(Threads& exec, const In& in, Out& out, T carry, Op& op) {
  const std::size_t n = std::size(in);
  auto before = make_buffer<T>(exec, block_count(n));
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    before[block] = fold_block<T>(in, begin, end, op);
  });
  for (T& b : before) {
    const T sum = b;
    b = carry;
    carry = static_cast<T>(op(carry, sum));
  }
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    scan_block<kInclusive>(in, out, begin, end, before[block], op);
  });
  return carry;
}

}  // namespace scan_detail

/// `initial`, usually the neutral element, comes first. Returns the sum of all. Computes in the
/// type of `initial`. `out` has the size of `in` and may be `in`.
template <class Exec, Readable In, Writable Out, class T, class Op = std::plus<>>
T exclusive_scan(Exec& exec, const In& in, Out&& out, T initial, Op op = {}) {
  assert(std::size(in) == std::size(out));
  return scan_detail::scan<false>(exec, in, out, initial, op);
}

/// The same, but each sum includes its own element.
template <class Exec, Readable In, Writable Out, class T, class Op = std::plus<>>
T inclusive_scan(Exec& exec, const In& in, Out&& out, T initial, Op op = {}) {
  assert(std::size(in) == std::size(out));
  return scan_detail::scan<true>(exec, in, out, initial, op);
}

}  // namespace rastrum::parallel
