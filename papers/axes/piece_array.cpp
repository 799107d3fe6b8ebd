// SPDX-License-Identifier: BSD-3-Clause
#include <papers/axes/piece_array.hpp>

#include <algorithm>
#include <atomic>

#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::family {
namespace {

/// Triangles of a task: few enough that its pieces stay in a core's L2 cache.
constexpr std::uint64_t kGroup = 4096;

}  // namespace

std::span<const Piece> PieceArray::fill(Frame& frame, std::uint64_t first, std::uint64_t last) {
  const auto group_count = static_cast<std::size_t>((last - first + kGroup - 1) / kGroup);
  while (groups_.size() < group_count) groups_.emplace_back(memory_);
  std::atomic<bool> in_range = true;
  parallel::for_each_index(frame.exec, group_count, [&](std::size_t g) {
    const std::uint64_t begin = first + g * kGroup;
    groups_[g].restart();
    if (!set_up(frame.base, begin, std::min(begin + kGroup, last), groups_[g])) in_range = false;
  });
  if (!in_range) check_indices(frame.request.draws, frame.request.names);

  std::vector<std::size_t> place(group_count);
  std::size_t total = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    place[g] = total;
    total += groups_[g].count;
    count_triangles(frame.base, groups_[g].triangles);
  }
  pieces_.reserve(total);
  parallel::for_each_index(frame.exec, group_count, [&](std::size_t g) {
    std::copy_n(groups_[g].data.data(), groups_[g].count, pieces_.data() + place[g]);
  });
  return {pieces_.data(), total};
}

}  // namespace rastrum::family
