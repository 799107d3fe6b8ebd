// SPDX-License-Identifier: BSD-3-Clause
// The order in which threads take neighbouring tasks of different size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rastrum::raster {

/// Makes tasks of items, which free threads begin in order (for_each_in_order). Items above an
/// eighth of a thread's share are a task each, the largest first, by powers of two. Smaller items
/// follow in their order, some together, because neighbours share what they read: a brain of a
/// million triangles took 15 % longer with all bins ordered by load. Keeps its memory.
class LoadOrder {
 public:
  /// Work O(items). With one thread each item is a task, in order.
  void arrange(std::span<const std::uint64_t> loads, int threads);

  [[nodiscard]] std::size_t tasks() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> task(std::size_t i) const {
    return {items_.data() + begin_[i], begin_[i + 1] - begin_[i]};
  }

 private:
  std::vector<std::uint32_t> items_;
  std::vector<std::size_t> begin_;
};

}  // namespace rastrum::raster
