// SPDX-License-Identifier: BSD-3-Clause
// The slots of the table of `hashed` and the order in which they are probed, for host and device.
//
// Blocks are hashed: the 64 samples of a block have 64 consecutive slots. A collision goes on to
// the next block's slots and the next sample, so that blocks with few samples share their slots.
#pragma once

#include <cstdint>
#include <numeric>

#include <papers/axes/names.hpp>
#include <rastrum/config.hpp>

namespace rastrum::family {

/// Marks an empty slot.
inline constexpr std::uint32_t kNoPixel = ~std::uint32_t{0};

struct HashSlots {
  /// Most entries per slot. With 0.5, 0.7 and 0.9 `sorted` took 1.06, 1.13 and 1.16 times the time
  /// of this (`rastrum bench hashed`, depth complexity 1, paired medians of 3 on a busy machine),
  /// and 1.37, 1.42 and 1.21 at complexity 8. Wholly covered blocks seldom collide, so memory
  /// decides until the table is nearly full.
  static constexpr std::uint64_t kLoadNumerator = 7, kLoadDenominator = 10;
  /// Bytes of a slot: a pixel and a key.
  static constexpr std::uint64_t kBytes = sizeof(std::uint32_t) + sizeof(std::uint64_t);

  std::uint64_t count;  ///< a multiple of 64

  static HashSlots of(std::uint64_t entries) {
    // At least two blocks' worth, because a step is longer than one block.
    std::uint64_t slots = (entries * kLoadDenominator / kLoadNumerator / 64 + 2) * 64;
    // The steps of a probe must reach every slot.
    while (std::gcd(slots, kStep) != 1) slots += 64;
    return {slots};
  }

  /// The first slot of a block's samples.
  [[nodiscard]] RASTRUM_HD std::uint64_t home(std::uint32_t block) const {
    const std::uint32_t hash = (block ^ block >> 15) * 0x9E3779B1U;
    return (std::uint64_t{hash} * (count / 64) >> 32) * 64;
  }
  [[nodiscard]] RASTRUM_HD std::uint64_t next(std::uint64_t slot) const {
    slot += kStep;
    return slot >= count ? slot - count : slot;
  }

 private:
  /// To the next block's slots and the next sample.
  static constexpr std::uint64_t kStep = 65;
};

}  // namespace rastrum::family
