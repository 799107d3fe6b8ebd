// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/blocks.hpp>

namespace rastrum::ranks {

BlockGrid::BlockGrid(int width, int top, int bottom, int ranks)
    : width_(width),
      top_(top),
      bottom_(bottom),
      columns_((width + kSide - 1) / kSide),
      count_(static_cast<std::size_t>(columns_) *
             static_cast<std::size_t>((bottom - top + kSide - 1) / kSide)) {
  const auto n = static_cast<std::uint64_t>(ranks);
  for (std::uint64_t r = 0; r <= n; ++r) firsts_.push_back(count_ * r / n);
}

std::size_t BlockGrid::owner(std::uint32_t block) const {
  const auto above = std::ranges::upper_bound(firsts_, std::uint64_t{block});
  return static_cast<std::size_t>(above - firsts_.begin()) - 1;
}

Mail::Mail(int ranks)
    : to_(static_cast<std::size_t>(ranks)),
      from_(to_.size()),
      to_sizes_(to_.size()),
      from_sizes_(to_.size()),
      to_views_(to_.size()),
      from_views_(to_.size()) {}

void Mail::exchange_sizes(Communicator& ranks) {
  for (std::size_t r = 0; r < to_.size(); ++r) to_sizes_[r] = to_[r].size();
  ranks.exchange_sizes(to_sizes_, from_sizes_);
}

void Mail::make_room() {
  for (std::size_t r = 0; r < to_.size(); ++r) {
    from_[r].resize(from_sizes_[r]);
    to_views_[r] = to_[r];
    from_views_[r] = from_[r];
  }
}

void Mail::begin_sizes(std::span<const std::size_t> to, std::span<const std::size_t> from) {
  std::ranges::fill(to_views_, std::span<const std::byte>{});
  std::ranges::fill(from_views_, std::span<std::byte>{});
  std::ranges::fill(from_sizes_, 0);
  for (const std::size_t r : to) {
    to_sizes_[r] = to_[r].size();
    to_views_[r] = std::as_bytes(std::span(&to_sizes_[r], 1));
  }
  for (const std::size_t r : from)
    from_views_[r] = std::as_writable_bytes(std::span(&from_sizes_[r], 1));
}

void Mail::take_sizes(std::span<const std::size_t> from) {
  std::ranges::fill(from_views_, std::span<std::byte>{});
  for (std::size_t r = 0; r < to_.size(); ++r) to_views_[r] = to_[r];
  for (const std::size_t r : from) {
    from_[r].resize(from_sizes_[r]);
    from_views_[r] = from_[r];
  }
}

void Mail::exchange(Communicator& ranks) {
  ranks.exchange(to_views_, from_views_);
}

}  // namespace rastrum::ranks
