// sort_by_key: sorts pairs by an unsigned integer key, stably, by LSD radix sort with digits of at
// most 8 bits; passes whose digit is the same in all keys are skipped.
//
// Threads cut the pairs into a few chunks each; a chunk counts its digits, a scan over (digit,
// chunk) gives every chunk its places, and the chunks write. A stable sort has one result, so the
// cut may depend on the number of threads.
// Work O(n · bits / 8), span O(bits / 8 · (n / threads + 256 · threads)). Allocates n keys and n
// values.
// Source: Zagha and Blelloch, "Radix sort for vector multiprocessors", 1991; paper 5, appendix A,
// takes a comparator instead, which the painting of pixels never needs.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::parallel {
namespace sort_detail {

inline constexpr int kDigitBits = 8;
inline constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
/// Fewer pairs than this a chunk are not worth a task and its 256 counters.
inline constexpr std::size_t kSmallestChunk = 16384;

using Counters = std::array<std::size_t, kDigits>;

[[nodiscard]] inline std::size_t chunks_for(const Serial&, std::size_t) {
  return 1;
}
[[nodiscard]] inline std::size_t chunks_for(const Threads& exec, std::size_t n) {
  const auto most = static_cast<std::size_t>(exec.concurrency()) * 2;
  return std::clamp<std::size_t>(n / kSmallestChunk, 1, exec.concurrency() > 1 ? most : 1);
}

/// Turns digit counts of the chunks into the place of each chunk's first pair of each digit.
/// Returns false where all pairs have one digit.
inline bool places(std::span<Counters> counters, std::size_t n) {
  std::size_t next = 0;
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    const std::size_t first = next;
    for (Counters& c : counters) next += std::exchange(c[digit], next);
    if (next - first == n) return false;
  }
  return true;
}

}  // namespace sort_detail

/// Sorts `keys` and, along with them, `values` (contiguous ranges of one size) by the low `bits`
/// bits of the keys; higher bits are carried along. Pairs of equal keys keep their order.
template <class Exec, class Keys, class Values>
void sort_by_key(Exec& exec, Keys&& key_range, Values&& value_range, int bits = -1) {
  using namespace sort_detail;
  const std::span keys(key_range);
  const std::span values(value_range);
  using K = typename decltype(keys)::value_type;
  using V = typename decltype(values)::value_type;
  static_assert(std::unsigned_integral<K>);
  assert(keys.size() == values.size());
  if (bits < 0) bits = std::numeric_limits<K>::digits;
  assert(bits <= std::numeric_limits<K>::digits);
  const std::size_t n = keys.size();
  if (n < 2) return;

  const int passes = (bits + kDigitBits - 1) / kDigitBits;
  const std::size_t chunk_count = chunks_for(exec, n);
  std::vector<Counters> counters(chunk_count);
  auto other_keys = make_buffer<K>(exec, n);
  auto other_values = make_buffer<V>(exec, n);
  std::span<K> from_keys = keys, to_keys = other_keys;
  std::span<V> from_values = values, to_values = other_values;

  for (int pass = 0; pass < passes; ++pass) {
    const int shift = pass * kDigitBits;
    const auto limit = (std::size_t{1} << std::min(kDigitBits, bits - shift)) - 1;
    const auto digit = [=](K key) { return static_cast<std::size_t>(key >> shift) & limit; };
    const auto chunk_begin = [&](std::size_t c) { return n / chunk_count * c; };
    const auto chunk_end = [&](std::size_t c) {
      return c + 1 == chunk_count ? n : chunk_begin(c + 1);
    };
    for_each_index(exec, chunk_count, [&](std::size_t c) {
      counters[c].fill(0);
      for (std::size_t i = chunk_begin(c); i < chunk_end(c); ++i)
        ++counters[c][digit(from_keys[i])];
    });
    if (!places(counters, n)) continue;
    for_each_index(exec, chunk_count, [&](std::size_t c) {
      Counters next = counters[c];
      for (std::size_t i = chunk_begin(c); i < chunk_end(c); ++i) {
        const std::size_t to = next[digit(from_keys[i])]++;
        to_keys[to] = from_keys[i];
        to_values[to] = from_values[i];
      }
    });
    std::swap(from_keys, to_keys);
    std::swap(from_values, to_values);
  }
  if (from_keys.data() == keys.data()) return;
  for_each_index(exec, chunk_count, [&](std::size_t c) {
    const std::size_t begin = n / chunk_count * c;
    const std::size_t end = c + 1 == chunk_count ? n : n / chunk_count * (c + 1);
    std::copy(from_keys.begin() + static_cast<std::ptrdiff_t>(begin),
              from_keys.begin() + static_cast<std::ptrdiff_t>(end),
              to_keys.begin() + static_cast<std::ptrdiff_t>(begin));
    std::copy(from_values.begin() + static_cast<std::ptrdiff_t>(begin),
              from_values.begin() + static_cast<std::ptrdiff_t>(end),
              to_values.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

}  // namespace rastrum::parallel
