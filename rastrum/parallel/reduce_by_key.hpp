// reduce_by_key: one key and one reduced value for each run of equal neighbouring keys.
//
// The operator must be associative. Where that holds only up to rounding the result is still one:
// a run is cut where blocks of kBlock elements begin, the pieces are folded from the left, and so
// are their results, whatever the backend and the number of threads.
// Work O(n), span O(kBlock + n / kBlock). Allocates the result; threads one value per block more.
// Source: paper 5, appendix A.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scan.hpp>

namespace rastrum::parallel {

template <class K, class V>
struct ReducedByKey {
  Buffer<K> keys;
  Buffer<V> values;
};

/// Sizes of `keys` and `values` agree. Sort by key first where equal keys are to meet.
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
  const std::size_t n = std::size(keys);
  const auto is_head = [&](std::size_t i) { return i == 0 || !(keys[i] == keys[i - 1]); };

  auto heads_before = make_buffer<std::size_t>(exec, block_count(n));
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::size_t heads = 0;
    for (std::size_t i = begin; i < end; ++i) heads += std::size_t{is_head(i)};
    heads_before[block] = heads;
  });
  const std::size_t runs = exclusive_scan(exec, heads_before, heads_before, std::size_t{0});

  ReducedByKey<element_t<Keys>, V> out{make_buffer<element_t<Keys>>(exec, runs),
                                       make_buffer<V>(exec, runs)};
  // A block's first piece, where it continues a run of the block before it.
  auto carried = make_buffer<V>(exec, block_count(n));
  auto carries = make_buffer<std::uint8_t>(exec, block_count(n));
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::size_t run = heads_before[block];
    carries[block] = 0;
    for (std::size_t i = begin; i < end;) {
      const bool head = is_head(i);
      V piece = values[i];
      std::size_t j = i + 1;
      for (; j < end && keys[j] == keys[i]; ++j) piece = static_cast<V>(op(piece, values[j]));
      if (head) {
        out.keys[run] = keys[i];
        out.values[run++] = piece;
      } else {
        carried[block] = piece;
        carries[block] = 1;
      }
      i = j;
    }
  });
  for (std::size_t block = 0; block < carried.size(); ++block)
    if (carries[block] != 0) {
      V& value = out.values[heads_before[block] - 1];
      value = static_cast<V>(op(value, carried[block]));
    }
  return out;
}

}  // namespace rastrum::parallel
