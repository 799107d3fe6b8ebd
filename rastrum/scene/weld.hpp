// SPDX-License-Identifier: BSD-3-Clause
// Joins vertices at one place, so that triangles that share no indices have neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/shares.hpp>
#include <rastrum/parallel/tabulate.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// A number per vertex, equal for equal positions, from 0 as they first come.
struct JoinedPoints {
  std::vector<std::uint32_t> of_vertex;
  std::size_t count = 0;
};

/// `position(v)`, for v < count < 2³², is a Vec3d or becomes one; called from any thread. Work
/// O(count · threads), span O(count); 12 bytes per vertex beside the result.
template <class Exec, class Position>
[[nodiscard]] JoinedPoints weld(Exec& exec, std::size_t count, const Position& position) {
  // −0 equals 0 but has other bits; adding 0 makes them equal.
  const auto key = [&](std::size_t vertex) {
    const Vec3d p = position(static_cast<std::uint32_t>(vertex));
    return std::bit_cast<std::array<std::uint64_t, 3>>(Vec3d{p.x + 0.0, p.y + 0.0, p.z + 0.0});
  };
  auto hashes = parallel::make_buffer<std::uint32_t>(exec, count);
  parallel::tabulate(exec, hashes, [&](std::size_t v) {
    const auto k = key(v);
    std::uint64_t h = k[0] * 0x9E3779B97F4A7C15ULL;
    h = (h ^ h >> 32 ^ k[1]) * 0xD6E8FEB86659FD93ULL;
    h = (h ^ h >> 32 ^ k[2]) * 0x9E3779B97F4A7C15ULL;
    return static_cast<std::uint32_t>(h >> 32);
  });

  // The first vertex of each place. A share has the places of a range of hashes.
  JoinedPoints points;
  std::vector<std::uint32_t>& first = points.of_vertex;
  first.resize(count);
  parallel::for_each_share(exec, [&](std::size_t share, std::size_t shares) {
    const auto mine = [&](std::size_t v) {
      return hashes[v] * std::uint64_t{shares} >> 32 == share;
    };
    std::size_t vertices = 0;
    for (std::size_t v = 0; v < count; ++v) vertices += mine(v) ? 1U : 0U;
    constexpr std::uint32_t kEmpty = ~0U;
    auto slots = parallel::make_buffer<std::uint32_t>(exec, std::bit_ceil(vertices * 2 + 2));
    std::fill(slots.begin(), slots.end(), kEmpty);
    for (std::size_t v = 0; v < count; ++v) {
      if (!mine(v)) continue;
      const auto k = key(v);
      std::size_t at = hashes[v] & (slots.size() - 1);
      while (slots[at] != kEmpty && key(slots[at]) != k) at = (at + 1) & (slots.size() - 1);
      if (slots[at] == kEmpty) slots[at] = static_cast<std::uint32_t>(v);
      first[v] = slots[at];
    }
  });

  auto& number = hashes;
  parallel::tabulate(exec, number,
                     [&](std::size_t v) { return static_cast<std::uint32_t>(first[v] == v); });
  points.count = parallel::exclusive_scan(exec, number, number, std::uint32_t{0});
  parallel::tabulate(exec, first, [&](std::size_t v) { return number[first[v]]; });
  return points;
}

}  // namespace rastrum
