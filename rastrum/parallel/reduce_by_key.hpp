// SPDX-License-Identifier: BSD-3-Clause
// reduce_by_key: one key and one reduced value for each run of equal neighbouring keys.
//
// The operator must be associative. The result is as deterministic as reduce's: runs are cut at
// blocks of kBlock elements, and the pieces and then their results are folded from the left.
// Work O(n), span O(kBlock + n / kBlock). Allocates the result; threads one value per block more.
// Source: paper 5, appendix A.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scan.hpp>

namespace rastrum::parallel {

template <class K, class V>
struct ReducedByKey {
  Buffer<K> keys;
  Buffer<V> values;
};

namespace by_key_detail {

// Passes over blocks: named functors over views, so that devices can run them.

template <class Keys>
[[nodiscard]] RASTRUM_HD bool is_head(const Keys& keys, std::size_t i) {
  return i == 0 || !(keys[i] == keys[i - 1]);
}

template <class Keys>
struct CountHeads {
  Keys keys;
  std::span<std::size_t> heads_before;
  RASTRUM_HD void operator()(std::size_t block, std::size_t begin, std::size_t end) const {
    std::size_t heads = 0;
    for (std::size_t i = begin; i < end; ++i) heads += std::size_t{is_head(keys, i)};
    heads_before[block] = heads;
  }
};

/// Writes the runs that begin in a block. If its first elements continue a run, `carried` gets
/// their reduction.
template <class K, class V, class Keys, class Values, class Op>
struct ReduceRuns {
  Keys keys;
  Values values;
  std::span<const std::size_t> heads_before;
  std::span<K> out_keys;
  std::span<V> out_values, carried;
  std::span<std::uint8_t> carries;
  Op op;
  RASTRUM_HD void operator()(std::size_t block, std::size_t begin, std::size_t end) const {
    Op plus = op;
    std::size_t run = heads_before[block];
    carries[block] = 0;
    for (std::size_t i = begin; i < end;) {
      const bool head = is_head(keys, i);
      V piece = values[i];
      std::size_t j = i + 1;
      for (; j < end && keys[j] == keys[i]; ++j) piece = static_cast<V>(plus(piece, values[j]));
      if (head) {
        out_keys[run] = keys[i];
        out_values[run++] = piece;
      } else {
        carried[block] = piece;
        carries[block] = 1;
      }
      i = j;
    }
  }
};

/// Adds the carried pieces to their runs, in order. Runs on one thread.
template <class V, class Op>
struct AddCarried {
  std::span<const std::size_t> heads_before;
  std::span<V> out_values;
  std::span<const V> carried;
  std::span<const std::uint8_t> carries;
  Op op;
  RASTRUM_HD void operator()(std::size_t) const {
    Op plus = op;
    for (std::size_t block = 0; block < carried.size(); ++block)
      if (carries[block] != 0) {
        V& value = out_values[heads_before[block] - 1];
        value = static_cast<V>(plus(value, carried[block]));
      }
  }
};

/// `Out` is the backend's ReducedByKey.
template <class Out, class K, class V, class Exec, class Keys, class Values, class Op>
[[nodiscard]] Out reduce_in_blocks(Exec& exec, Keys keys, Values values, Op op) {
  const std::size_t n = std::size(keys);
  auto heads_before = make_buffer<std::size_t>(exec, block_count(n));
  const auto heads = view_of(heads_before);
  for_each_block(exec, n, CountHeads<Keys>{keys, heads});
  const std::size_t runs = exclusive_scan(exec, heads_before, heads_before, std::size_t{0});

  Out out{make_buffer<K>(exec, runs), make_buffer<V>(exec, runs)};
  auto carried = make_buffer<V>(exec, block_count(n));
  auto carries = make_buffer<std::uint8_t>(exec, block_count(n));
  for_each_block(exec, n,
                 ReduceRuns<K, V, Keys, Values, Op>{keys, values, heads, view_of(out.keys),
                                                    view_of(out.values), view_of(carried),
                                                    view_of(carries), op});
  for_each_index(
      exec, 1,
      AddCarried<V, Op>{heads, view_of(out.values), view_of(carried), view_of(carries), op});
  return out;
}

}  // namespace by_key_detail

/// `keys` and `values` have the same size. Sort by key first if equal keys are to meet.
template <Readable Keys, Readable Values, class Op = std::plus<>>
[[nodiscard]] ReducedByKey<element_t<Keys>, element_t<Values>> reduce_by_key(Serial& exec,
                                                                             const Keys& keys,
                                                                             const Values& values,
                                                                             Op op = {}) {
  using V = element_t<Values>;
  assert(std::size(keys) == std::size(values));
  ReducedByKey<element_t<Keys>, V> out{make_buffer<element_t<Keys>>(exec), make_buffer<V>(exec)};
  const std::size_t n = std::size(keys);
  for (std::size_t i = 0; i < n;) {
    const bool head = i == 0 || !(keys[i] == keys[i - 1]);
    const std::size_t block_end = std::min(n, (i / kBlock + 1) * kBlock);
    V piece = values[i];
    std::size_t j = i + 1;
    for (; j < block_end && keys[j] == keys[i]; ++j) piece = static_cast<V>(op(piece, values[j]));
    if (head) {
      out.keys.push_back(keys[i]);
      out.values.push_back(piece);
    } else {
      out.values.back() = static_cast<V>(op(out.values.back(), piece));
    }
    i = j;
  }
  return out;
}

template <Readable Keys, Readable Values, class Op = std::plus<>>
[[nodiscard]] ReducedByKey<element_t<Keys>, element_t<Values>> reduce_by_key(Threads& exec,
                                                                             const Keys& keys,
                                                                             const Values& values,
                                                                             Op op = {}) {
  using V = element_t<Values>;
  assert(std::size(keys) == std::size(values));
  return by_key_detail::reduce_in_blocks<ReducedByKey<element_t<Keys>, V>, element_t<Keys>, V>(
      exec, view_of(keys), view_of(values), op);
}

}  // namespace rastrum::parallel
