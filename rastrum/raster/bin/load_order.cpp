// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/bin/load_order.hpp>

#include <algorithm>
#include <array>
#include <bit>

namespace rastrum::raster {
namespace {

/// Fractions of a thread's share: an item above 1 / kLarge is a task of its own; small items
/// together make tasks of 1 / kTogether.
constexpr std::uint64_t kLarge = 8, kTogether = 32;

}  // namespace

void LoadOrder::arrange(std::span<const std::uint64_t> loads, int threads) {
  items_.clear();
  begin_.clear();
  std::uint64_t total = 0;
  for (const std::uint64_t load : loads) total += load;
  const std::uint64_t share = total / static_cast<std::uint64_t>(threads);
  // Twice the load has one more digit.
  const auto digits = [&](std::uint64_t load) {
    return threads == 1 || load <= share / kLarge ? 0U
                                                  : static_cast<unsigned>(std::bit_width(load));
  };
  std::array<std::uint32_t, 65> count{};
  for (const std::uint64_t load : loads) ++count[digits(load)];
  std::array<std::uint32_t, 65> next{};
  std::uint32_t at = 0;
  for (std::size_t d = 64; d > 0; --d) {
    next[d] = at;
    at += count[d];
  }
  const std::size_t large = at;
  next[0] = at;
  items_.resize(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i)
    items_[next[digits(loads[i])]++] = static_cast<std::uint32_t>(i);

  for (std::size_t i = 0; i < large; ++i) begin_.push_back(i);
  std::uint64_t together = 0;
  const std::uint64_t enough = threads == 1 ? 0 : share / kTogether;
  for (std::size_t i = large; i < items_.size(); ++i) {
    if (i == large || together >= enough) {
      begin_.push_back(i);
      together = 0;
    }
    together += loads[items_[i]];
  }
  begin_.push_back(items_.size());
}

}  // namespace rastrum::raster
