// SPDX-License-Identifier: BSD-3-Clause
// Mail by two hops. Ranks form a grid; each sends its mail first along its row and then along the
// receiver's column. So a rank talks to some 2 √N ranks instead of N, and each byte is sent twice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <rastrum/ranks/agree.hpp>
#include <rastrum/ranks/blocks.hpp>

namespace rastrum::ranks {

/// Bytes that travel while one message more is sent: half a microsecond at 20 GB/s.
inline constexpr std::uint64_t kBytesAMessage = 10'000;
/// With fewer ranks each sends to each.
inline constexpr std::size_t kLeastForHops = 16;

class HopGrid {
 public:
  explicit HopGrid(std::size_t ranks);
  /// The rank that forwards mail from one rank to another; it may be either of them.
  [[nodiscard]] std::size_t via(std::size_t from, std::size_t to) const {
    const std::size_t m = from / columns_ * columns_ + to % columns_;
    return m < ranks_ ? m : m - columns_;  // the last row may be short
  }
  /// The ranks to which a rank sends in the first and in the second hop, and from which it
  /// receives.
  [[nodiscard]] std::vector<std::size_t> first_to(std::size_t rank) const;
  [[nodiscard]] std::vector<std::size_t> first_from(std::size_t rank) const;
  [[nodiscard]] std::vector<std::size_t> second(std::size_t rank) const;  ///< both ways
  /// The most messages that a rank sends in both hops, messages with sizes included.
  [[nodiscard]] std::uint64_t messages() const {
    return 2 * (columns_ + (ranks_ + columns_ - 1) / columns_ - 2);
  }

 private:
  std::size_t ranks_, columns_;
};

/// Sends `mail` to all ranks directly: sizes, room for what comes, contents.
void exchange_with_all(Communicator& ranks, const AtPhase& at, Mail& mail, std::string_view room);

/// One hop: sends sizes, makes room, sends the contents of `mail`, which is for no rank but these.
void exchange_among(Communicator& ranks, const AtPhase& at, Mail& mail,
                    const std::vector<std::size_t>& to, const std::vector<std::size_t>& from,
                    std::string_view room);

/// Has the result of an exchange of all with all: `mail` then has what came from each rank.
void exchange_by_hops(Communicator& ranks, const AtPhase& at, Mail& mail, std::string_view room);

/// Whether hops cost less where this rank has `bytes` for `receivers` other ranks. Costs are bytes;
/// each message counts as kBytesAMessage more. The busiest rank decides. A collective.
[[nodiscard]] bool hops_cost_less(Communicator& ranks, std::uint64_t bytes,
                                  std::uint64_t receivers);

}  // namespace rastrum::ranks
