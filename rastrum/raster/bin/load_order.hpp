// SPDX-License-Identifier: BSD-3-Clause
// In which order threads take tasks of different size that lie beside each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rastrum::raster {

/// Items become tasks, to be begun one after the other by whoever is free (for_each_in_order).
/// Items of more than an eighth of a thread's share of everything are a task each, the largest
/// first, by powers of two; what is smaller goes in the order of its numbers, some together.
/// Neighbours share what they read: a brain of a million triangles took 15 % longer with all its
/// bins by load. Keeps its memory.
class LoadOrder {
 public:
  /// Work O(items). One thread: each item a task, in order.
  void arrange(std::span<const std::uint64_t> loads, int threads);

  [[nodiscard]] std::size_t tasks() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  /// The items of a task.
  [[nodiscard]] std::span<const std::uint32_t> task(std::size_t i) const {
    return {items_.data() + begin_[i], begin_[i + 1] - begin_[i]};
  }

 private:
  std::vector<std::uint32_t> items_;
  std::vector<std::size_t> begin_;
};

}  // namespace rastrum::raster
