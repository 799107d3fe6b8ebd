// SPDX-License-Identifier: BSD-3-Clause
// Bit masks of 8 to 256 bits with the three operations that expand_masked needs: set, rank, select.
//
// Source: paper 1, section 3.1.1. select clears lowest bits in up to 8 bits and halves wider words.
// Beyond 64 bits a mask is a pair of masks, so that rank and select cost O(log bits).
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <type_traits>

#include <rastrum/config.hpp>

namespace rastrum::parallel {

RASTRUM_HD constexpr int popcount(std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __popcll(bits);
#elif defined(__POPCNT__) || defined(__aarch64__)
  return std::popcount(bits);
#else
  // Baseline x86-64 has no such instruction, and libgcc's table took a tenth of a frame of
  // `scanline` × `sorted`. Sums of 2, 4, 8 bits, then of the bytes (Knuth, TAOCP 4A, 7.1.3).
  bits -= bits >> 1 & 0x5555555555555555U;
  bits = (bits & 0x3333333333333333U) + (bits >> 2 & 0x3333333333333333U);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<int>(bits * 0x0101010101010101U >> 56);
#endif
}

/// Index of the lowest set bit. Requires bits ≠ 0.
RASTRUM_HD constexpr int lowest_bit(std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(bits)) - 1;
#else
  return std::countr_zero(bits);
#endif
}

/// Index of the set bit that has k set bits below it, within the low `kWidth` bits. Requires 0 ≤ k
/// < the number of set bits.
template <int kWidth>
RASTRUM_HD constexpr int select_bit(std::uint64_t bits, int k) {
  if constexpr (kWidth <= 8) {
    for (; k > 0; --k) bits &= bits - 1;
    return lowest_bit(bits);
  } else {
    constexpr int kHalf = kWidth / 2;
    const int low = popcount(bits & ((std::uint64_t{1} << kHalf) - 1));
    return k < low ? select_bit<kHalf>(bits, k) : select_bit<kHalf>(bits >> kHalf, k - low) + kHalf;
  }
}

/// A set of the numbers 0 … kBits − 1.
template <int kBits>
class Mask {
  static_assert(kBits == 128 || kBits == 256, "masks have 8, 16, 32, 64, 128 or 256 bits");

 public:
  static constexpr int size() { return kBits; }
  /// The i < n for which holds(i), called once each in ascending order; 0 ≤ n ≤ kBits. Without
  /// branches, because they would be unpredictable.
  template <class Holds>
  [[nodiscard]] RASTRUM_HD static constexpr Mask of(int n, Holds&& holds) {
    Mask mask;
    mask.low_ = Mask<kHalf>::of(n < kHalf ? n : kHalf, holds);
    if (n > kHalf) mask.high_ = Mask<kHalf>::of(n - kHalf, [&](int i) { return holds(i + kHalf); });
    return mask;
  }
  RASTRUM_HD constexpr void set(int i) { i < kHalf ? low_.set(i) : high_.set(i - kHalf); }
  [[nodiscard]] RASTRUM_HD constexpr bool test(int i) const {
    return i < kHalf ? low_.test(i) : high_.test(i - kHalf);
  }
  /// Number of elements.
  [[nodiscard]] RASTRUM_HD constexpr int rank() const { return low_.rank() + high_.rank(); }
  /// Number of elements < i; 0 ≤ i ≤ kBits. rank(select(k)) = k.
  [[nodiscard]] RASTRUM_HD constexpr int rank(int i) const {
    return i <= kHalf ? low_.rank(i) : low_.rank() + high_.rank(i - kHalf);
  }
  /// The element that has k elements below it. Requires 0 ≤ k < rank().
  [[nodiscard]] RASTRUM_HD constexpr int select(int k) const {
    const int low = low_.rank();
    return k < low ? low_.select(k) : high_.select(k - low) + kHalf;
  }
  /// Calls f(i) for each element, ascending: select(0), select(1), … for O(1) each.
  template <class F>
  RASTRUM_HD constexpr void for_each(F&& f) const {
    low_.for_each(f);
    high_.for_each([&](int i) { f(i + kHalf); });
  }

 private:
  static constexpr int kHalf = kBits / 2;
  Mask<kHalf> low_, high_;
};

template <int kBits>
requires(kBits == 8 || kBits == 16 || kBits == 32 || kBits == 64) class Mask<kBits> {
 public:
  using Word = std::conditional_t<
      kBits == 8, std::uint8_t,
      std::conditional_t<kBits == 16, std::uint16_t,
                         std::conditional_t<kBits == 32, std::uint32_t, std::uint64_t>>>;

  static constexpr int size() { return kBits; }
  template <class Holds>
  [[nodiscard]] RASTRUM_HD static constexpr Mask of(int n, Holds&& holds) {
    assert(n >= 0 && n <= kBits);
    // Shifts down from the top, because a shift by a constant is cheaper than one by i.
    std::uint64_t bits = 0;
    for (int i = 0; i < n; ++i) bits = bits >> 1 | std::uint64_t{static_cast<bool>(holds(i))} << 63;
    Mask mask;
    mask.word_ = n == 0 ? Word{0} : static_cast<Word>(bits >> (64 - n));
    return mask;
  }
  RASTRUM_HD constexpr void set(int i) {
    assert(i >= 0 && i < kBits);
    word_ = static_cast<Word>(word_ | std::uint64_t{1} << i);
  }
  [[nodiscard]] RASTRUM_HD constexpr bool test(int i) const {
    assert(i >= 0 && i < kBits);
    return (word_ >> i & 1) != 0;
  }
  [[nodiscard]] RASTRUM_HD constexpr int rank() const { return popcount(word_); }
  [[nodiscard]] RASTRUM_HD constexpr int rank(int i) const {
    assert(i >= 0 && i <= kBits);
    return i == kBits ? rank() : popcount(word_ & ((std::uint64_t{1} << i) - 1));
  }
  [[nodiscard]] RASTRUM_HD constexpr int select(int k) const {
    assert(k >= 0 && k < rank());
    return select_bit<kBits>(word_, k);
  }
  template <class F>
  RASTRUM_HD constexpr void for_each(F&& f) const {
    for (std::uint64_t rest = word_; rest != 0; rest &= rest - 1) f(lowest_bit(rest));
  }

 private:
  Word word_ = 0;
};

}  // namespace rastrum::parallel
