// SPDX-License-Identifier: BSD-3-Clause
// Bit masks of the elements for which a predicate holds, and where each block's share goes: the
// first half of filter and partition with threads. A bit saves a second call of the predicate (the
// idea of paper 1's expand_masked).
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/scan.hpp>

namespace rastrum::parallel {

struct Selection {
  Buffer<std::uint64_t> words;  ///< bit i % 64 of word i / 64
  Buffer<std::size_t> before;   ///< selected elements before each block
  std::size_t count = 0;

  [[nodiscard]] bool test(std::size_t i) const { return (words[i / 64] >> (i % 64) & 1) != 0; }
};

/// Work O(n), span O(kBlock). Allocates n / 8 bytes and one word per block.
template <Readable In, class Predicate>
[[nodiscard]] Selection select_elements(Threads& exec, const In& in, Predicate& holds) {
  const std::size_t n = std::size(in);
  Selection s{make_buffer<std::uint64_t>(exec, (n + 63) / 64),
              make_buffer<std::size_t>(exec, block_count(n))};
  for_each_block(exec, n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; i += 64) {
      std::uint64_t word = 0;
      for (std::size_t j = 0; j < 64 && i + j < end; ++j)
        word |= std::uint64_t{static_cast<bool>(holds(in[i + j]))} << j;
      s.words[i / 64] = word;
      count += static_cast<std::size_t>(popcount(word));
    }
    s.before[block] = count;
  });
  s.count = exclusive_scan(exec, s.before, s.before, std::size_t{0});
  return s;
}

}  // namespace rastrum::parallel
