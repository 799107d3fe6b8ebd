// SPDX-License-Identifier: BSD-3-Clause
// sort_by_key: a stable radix sort of pairs by an unsigned integer key. One pass on the highest
// digit makes buckets that fit a core's cache; each is then sorted on its lower digits, lowest
// first.
//
// Bits equal in all keys are left out; they are found while a guess of the highest digit is
// counted. All threads together sort a bucket that does not fit (most keys share one digit). Pairs
// alternate between the caller's arrays and an array of pairs, so the number of passes is even.
// Writes to many places are collected by cache lines. The cut may depend on the number of threads,
// because a stable sort has only one result.
//
// Work O(n · bits / 11), span O(n / threads + 2048 · threads + kLargeBucket). Allocates n packed
// pairs. Sources: Zagha and Blelloch, "Radix sort for vector multiprocessors", 1991; for the lines,
// Satish et al., "Fast sort on CPUs and GPUs", 2010. Paper 5, appendix A, takes a comparator
// instead, which painting pixels never needs.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>

namespace rastrum::parallel {
namespace sort_detail {

/// Writing to more places at once exceeds the second-level cache.
inline constexpr int kMostFirstBits = 10, kMostDigitBits = 11;
/// The target size of a bucket, in pairs, and the most that one thread sorts.
inline constexpr std::size_t kBucket = 4096, kLargeBucket = std::size_t{1} << 17;
/// With 4-byte keys and values the pairs of a line fill a cache line.
inline constexpr std::size_t kLine = 8;
/// 4-byte keys of so many prefetched pairs fill a cache line.
inline constexpr std::uint32_t kFetched = 16;
/// Chunks with fewer pairs are not worth a task and its counters.
inline constexpr std::size_t kSmallestChunk = 16384;

#pragma pack(push, 1)
template <class K, class V>
struct Pair {
  static_assert(std::is_trivially_copyable_v<V>);
  K key;
  V value;
};
#pragma pack(pop)

/// The two layouts of pairs.
template <class K, class V>
struct Columns {
  K* keys;
  V* values;
  [[nodiscard]] K key(std::size_t i) const { return keys[i]; }
  [[nodiscard]] Pair<K, V> get(std::size_t i) const { return {keys[i], values[i]}; }
  void put(std::size_t i, const Pair<K, V>& pair) const {
    keys[i] = pair.key;
    values[i] = pair.value;
  }
  void put_line(std::size_t i, const Pair<K, V>* line, std::size_t n) const {
    for (std::size_t k = 0; k < n; ++k) put(i + k, line[k]);
  }
  void fetch(std::size_t i) const {
    __builtin_prefetch(keys + i, 1);
    __builtin_prefetch(values + i, 1);
  }
  [[nodiscard]] Columns from(std::size_t begin) const { return {keys + begin, values + begin}; }
};
template <class K, class V>
struct Rows {
  Pair<K, V>* pairs;
  [[nodiscard]] K key(std::size_t i) const { return pairs[i].key; }
  [[nodiscard]] Pair<K, V> get(std::size_t i) const { return pairs[i]; }
  void put(std::size_t i, const Pair<K, V>& pair) const { pairs[i] = pair; }
  void put_line(std::size_t i, const Pair<K, V>* line, std::size_t n) const {
    if (n == kLine)
      std::copy_n(line, kLine, pairs + i);  // the common case, with a constant size
    else
      std::copy_n(line, n, pairs + i);
  }
  void fetch(std::size_t) const {}  // was read a moment ago
  [[nodiscard]] Rows from(std::size_t begin) const { return {pairs + begin}; }
};

/// Bits [shift, shift + width) of a key.
struct Digit {
  int shift = 0, width = 0;
  Digit() = default;
  /// A digit without bits may begin behind the key's last bit, which is too far to shift.
  Digit(int first, int bits) : shift(bits == 0 ? 0 : first), width(bits) {}
  bool operator==(const Digit&) const = default;
  [[nodiscard]] std::size_t count() const { return std::size_t{1} << width; }
  template <class K>
  [[nodiscard]] std::size_t of(K key) const {
    return static_cast<std::size_t>(key >> shift) & (count() - 1);
  }
};

/// Makes counts[d] the place of the first pair of digit d; returns the sum of the counts.
template <class Count>
Count places(Count* counts, std::size_t stride, std::size_t n, Count next = 0) {
  for (std::size_t i = 0; i < n; ++i) next += std::exchange(counts[i * stride], next);
  return next;
}

inline constexpr std::size_t kMostCounters = std::size_t{1} << kMostDigitBits;

/// Moves n pairs to their places; `counts` says how many have each digit.
template <class From, class To>
void move_pairs(From from, To to, std::uint32_t n, Digit digit, std::uint32_t* counts) {
  places(counts, 1, digit.count());
  for (std::uint32_t i = 0; i < n; ++i) to.put(counts[digit.of(from.key(i))]++, from.get(i));
}

/// One stable pass on `digit` for pairs that fit a cache: count, then move. Meanwhile the lines of
/// `to` are prefetched, because stores to uncached lines wait for each other.
template <class From, class To>
void pass(From from, To to, std::uint32_t n, Digit digit) {
  std::array<std::uint32_t, kMostCounters> counts;
  std::fill_n(counts.begin(), digit.count(), 0U);
  for (std::uint32_t i = 0; i < n;) {
    to.fetch(i);
    for (const std::uint32_t end = std::min(n, i + kFetched); i < end; ++i)
      ++counts[digit.of(from.key(i))];
  }
  move_pairs(from, to, n, digit, counts.data());
}

/// The same on two digits, via `middle`; both are counted at once.
template <class From, class Middle, class To>
void two_passes(From from, Middle middle, To to, std::uint32_t n, Digit first, Digit second) {
  // Adjacent: at a distance of 4096 bytes, loads from one would wait for stores to the other.
  std::array<std::uint32_t, 2 * kMostCounters> counts;
  std::uint32_t* const second_counts = counts.data() + first.count();
  std::fill_n(counts.begin(), first.count() + second.count(), 0U);
  for (std::uint32_t i = 0; i < n;) {
    to.fetch(i);
    for (const std::uint32_t end = std::min(n, i + kFetched); i < end; ++i) {
      const auto key = from.key(i);
      ++counts[first.of(key)];
      ++second_counts[second.of(key)];
    }
  }
  move_pairs(from, middle, n, first, counts.data());
  move_pairs(middle, to, n, second, second_counts);
}

/// Moves pairs [begin, end) to next[digit], which advances, by full lines of kLine pairs. `first`
/// and `lines` have room for a number and a line per digit.
template <class From, class To, class P>
void move_lines(From from, To to, std::size_t begin, std::size_t end, Digit digit,
                std::size_t* next, std::size_t* first, P* lines) {
  std::copy_n(next, digit.count(), first);
  const auto flush = [&](std::size_t d, std::size_t line_end) {
    const std::size_t line_begin = std::max(first[d], (line_end - 1) / kLine * kLine);
    to.put_line(line_begin, lines + d * kLine + line_begin % kLine, line_end - line_begin);
  };
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t d = digit.of(from.key(i)), k = next[d]++;
    lines[d * kLine + k % kLine] = from.get(i);
    if (k % kLine == kLine - 1) flush(d, k + 1);
  }
  for (std::size_t d = 0; d < digit.count(); ++d)
    if (next[d] % kLine != 0 && next[d] > first[d]) flush(d, next[d]);
}

[[nodiscard]] inline std::size_t chunks_for(const Serial&, std::size_t) {
  return 1;
}
[[nodiscard]] inline std::size_t chunks_for(const Threads& exec, std::size_t n) {
  return std::clamp<std::size_t>(n / kSmallestChunk, 1,
                                 static_cast<std::size_t>(exec.concurrency()));
}

/// Calls f(chunk, begin, end) for `chunks` ranges that make up [0, n), equal but for the last.
template <class Exec, class F>
void for_each_chunk(Exec& exec, std::size_t n, std::size_t chunks, F&& f) {
  for_each_index(exec, chunks, [&](std::size_t c) {
    f(c, n / chunks * c, c + 1 == chunks ? n : n / chunks * (c + 1));
  });
}

/// How often each chunk of [0, n) has each value of `digit`. `differing` becomes the bits in which
/// keys differ.
template <class Exec, class From, class K>
Buffer<std::size_t> count_digits(Exec& exec, From from, std::size_t n, Digit digit, K& differing) {
  const std::size_t chunks = chunks_for(exec, n), digits = digit.count();
  auto counts = make_buffer<std::size_t>(exec, chunks * digits);
  auto differ = make_buffer<K>(exec, chunks);
  for_each_chunk(exec, n, chunks, [&](std::size_t c, std::size_t begin, std::size_t end) {
    std::size_t* const own = counts.data() + c * digits;
    std::fill_n(own, digits, std::size_t{0});
    const K some = from.key(0);
    K bits = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const K key = from.key(i);
      bits = static_cast<K>(bits | (key ^ some));
      ++own[digit.of(key)];
    }
    differ[c] = bits;
  });
  differing = std::accumulate(differ.begin(), differ.end(), K{0}, std::bit_or<>());
  return counts;
}

/// One stable pass by all threads: a scan of count_digits' result over (digit, chunk) finds each
/// chunk's places. Returns where each digit begins, and n.
template <class Exec, class From, class To>
Buffer<std::size_t> move_together(Exec& exec, From from, To to, std::size_t n, Digit digit,
                                  Buffer<std::size_t> next) {
  using P = decltype(from.get(0));
  const std::size_t chunks = chunks_for(exec, n), digits = digit.count();
  auto first = make_buffer<std::size_t>(exec, digits + 1);
  std::size_t before = 0;
  for (std::size_t d = 0; d < digits; ++d) {
    first[d] = before;
    before = places(next.data() + d, digits, chunks, before);
  }
  first[digits] = before;
  auto lines = make_buffer<P>(exec, chunks * digits * kLine);
  auto begins = make_buffer<std::size_t>(exec, chunks * digits);
  for_each_chunk(exec, n, chunks, [&](std::size_t c, std::size_t begin, std::size_t end) {
    move_lines(from, to, begin, end, digit, next.data() + c * digits, begins.data() + c * digits,
               lines.data() + c * digits * kLine);
  });
  return first;
}

template <class Exec, class From, class To>
void pass_together(Exec& exec, From from, To to, std::size_t n, Digit digit) {
  decltype(from.key(0)) differing;
  auto counts = count_digits(exec, from, n, digit, differing);
  move_together(exec, from, to, n, digit, std::move(counts));
}

/// The cut of bits [low, high) into `count` digits, lowest first.
struct Digits {
  int low, high, width, count;
  Digits(int low_bit, int high_bit, std::size_t n) : low(low_bit), high(high_bit) {
    // With few pairs large digits are not worth their counters.
    const int most = std::clamp(static_cast<int>(std::bit_width(n)), 6, kMostDigitBits);
    count = std::max(1, (high - low + most - 1) / most);
    width = (high - low + count - 1) / count;
  }
  [[nodiscard]] Digit operator[](int i) const {
    const int shift = std::min(low + i * width, high);
    return {shift, std::min(width, high - shift)};
  }
};

/// Sorts the n pairs of `rows` into `columns`; an even number of passes also uses `room`.
template <class Rows, class Columns>
void sort_bucket(Rows rows, Columns columns, Rows room, std::uint32_t n, const Digits& digits) {
  const int last = digits.count - 1;
  int i = 0;
  for (; i + 1 < last; i += 2) two_passes(rows, columns, rows, n, digits[i], digits[i + 1]);
  if (i == last) return pass(rows, columns, n, digits[i]);
  two_passes(rows, room, columns, n, digits[i], digits[last]);
}

/// The same by all threads, for a bucket that fits no cache.
template <class Exec, class Rows, class Columns>
void sort_bucket_together(Exec& exec, Rows rows, Columns columns, std::size_t n,
                          const Digits& digits) {
  for (int i = 0; i < digits.count; ++i)
    if (i % 2 == 0)
      pass_together(exec, rows, columns, n, digits[i]);
    else
      pass_together(exec, columns, rows, n, digits[i]);
  if (digits.count % 2 == 0) pass_together(exec, rows, columns, n, Digit{});
}

}  // namespace sort_detail

/// Sorts `keys`, and `values` along with them (contiguous ranges of one size), by the low `bits`
/// bits of the keys. Stable.
template <class Exec, class Keys, class Values>
void sort_by_key(Exec& exec, Keys&& key_range, Values&& value_range, int bits = -1) {
  using namespace sort_detail;
  const std::span keys(key_range);
  const std::span values(value_range);
  using K = typename decltype(keys)::value_type;
  using V = typename decltype(values)::value_type;
  static_assert(std::unsigned_integral<K>);
  assert(keys.size() == values.size());
  constexpr int kKeyBits = std::numeric_limits<K>::digits;
  if (bits < 0) bits = kKeyBits;
  assert(bits <= kKeyBits);
  const std::size_t n = keys.size();
  if (n < 2 || bits == 0) return;

  const Columns<K, V> columns{keys.data(), values.data()};
  const auto first_width = [n](int at_most) {
    return std::min({static_cast<int>(std::bit_width(n / kBucket)), kMostFirstBits, at_most});
  };
  // A guess, because the count also finds the differing bits: mostly the highest one differs.
  const Digit guess{bits - first_width(bits), first_width(bits)};
  K differing;
  auto counts = count_digits(exec, columns, n, guess, differing);
  const K all = static_cast<K>(std::numeric_limits<K>::max() >> (kKeyBits - bits));
  differing = static_cast<K>(differing & all);
  if (differing == 0) return;
  const int low = std::countr_zero(differing), high = static_cast<int>(std::bit_width(differing));
  const int middle = high - first_width(high - low);
  const Digit digit{middle, high - middle};
  if (!(digit == guess)) counts = count_digits(exec, columns, n, digit, differing);

  auto pairs = make_buffer<Pair<K, V>>(exec, n);
  const Rows<K, V> rows{pairs.data()};
  const auto first = move_together(exec, columns, rows, n, digit, std::move(counts));

  ScratchPool<Buffer<Pair<K, V>>> rooms([&] { return make_buffer<Pair<K, V>>(exec, 0); });
  const std::size_t buckets = first.size() - 1;
  const auto size = [&](std::size_t bucket) { return first[bucket + 1] - first[bucket]; };
  for (std::size_t b = 0; b < buckets; ++b)
    if (size(b) > kLargeBucket)
      sort_bucket_together(exec, rows.from(first[b]), columns.from(first[b]), size(b),
                           Digits(low, middle, size(b)));
  for_each_with_scratch(exec, buckets, rooms, [&](std::size_t b, Buffer<Pair<K, V>>& room) {
    if (size(b) == 0 || size(b) > kLargeBucket) return;
    if (room.size() < size(b)) room.resize(size(b));
    sort_bucket(rows.from(first[b]), columns.from(first[b]), Rows<K, V>{room.data()},
                static_cast<std::uint32_t>(size(b)), Digits(low, middle, size(b)));
  });
}

}  // namespace rastrum::parallel
