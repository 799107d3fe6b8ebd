// SPDX-License-Identifier: BSD-3-Clause
// Mail in two hops. Ranks form a grid; each sends its mail along its row, then along the receiver's
// column. So a rank talks to about 2 √N ranks instead of N, and each byte is sent twice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <rastrum/ranks/agree.hpp>
#include <rastrum/ranks/blocks.hpp>

namespace rastrum::ranks {

/// The cost of a message in bytes: half a microsecond at 20 GB/s.
inline constexpr std::uint64_t kBytesAMessage = 10'000;
/// Fewer ranks send directly.
inline constexpr std::size_t kLeastForHops = 16;

class HopGrid {
 public:
  explicit HopGrid(std::size_t ranks);
  /// The rank that forwards mail from one rank to another; it may be either of them.
  [[nodiscard]] std::size_t via(std::size_t from, std::size_t to) const {
    const std::size_t m = from / columns_ * columns_ + to % columns_;
    return m < ranks_ ? m : m - columns_;  // the last row may be short
  }
  /// The peers of a rank in the first and in the second hop.
  [[nodiscard]] std::vector<std::size_t> first_to(std::size_t rank) const;
  [[nodiscard]] std::vector<std::size_t> first_from(std::size_t rank) const;
  [[nodiscard]] std::vector<std::size_t> second(std::size_t rank) const;  ///< in both directions
  /// The most messages of a rank in both hops, including those with sizes.
  [[nodiscard]] std::uint64_t messages() const {
    return 2 * (columns_ + (ranks_ + columns_ - 1) / columns_ - 2);
  }

 private:
  std::size_t ranks_, columns_;
};

/// Sends `mail` to all ranks directly: sizes, room for what comes, contents.
void exchange_with_all(Communicator& ranks, const AtPhase& at, Mail& mail, std::string_view room);

/// One hop: sends sizes, makes room, sends `mail`, which is only for these ranks.
void exchange_among(Communicator& ranks, const AtPhase& at, Mail& mail,
                    const std::vector<std::size_t>& to, const std::vector<std::size_t>& from,
                    std::string_view room);

/// Same result as exchange_with_all.
void exchange_by_hops(Communicator& ranks, const AtPhase& at, Mail& mail, std::string_view room);

/// Whether hops cost less, given `bytes` for `receivers` other ranks. The cost is in bytes, plus
/// kBytesAMessage per message; the busiest rank decides. A collective call.
[[nodiscard]] bool hops_cost_less(Communicator& ranks, std::uint64_t bytes,
                                  std::uint64_t receivers);

}  // namespace rastrum::ranks
