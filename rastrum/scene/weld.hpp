// Vertices at one place are one point, so that triangles that share no indices have neighbours.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <rastrum/vec.hpp>

namespace rastrum {

/// A number for each vertex, the same for equal positions, counted from 0 as they first come.
struct JoinedPoints {
  std::vector<std::uint32_t> of_vertex;
  std::size_t count = 0;
};

/// `position(v)` of each vertex v < count is a Vec3d, or becomes one. O(count).
template <class Position>
[[nodiscard]] JoinedPoints weld(std::size_t count, const Position& position) {
  // -0 equals 0 and has other bits; adding 0 makes them one.
  const auto key = [&](std::uint32_t vertex) {
    const Vec3d p = position(vertex);
    return std::bit_cast<std::array<std::uint64_t, 3>>(Vec3d{p.x + 0.0, p.y + 0.0, p.z + 0.0});
  };
  constexpr std::uint32_t kEmpty = ~0U;
  std::vector<std::uint32_t> slots(std::bit_ceil(count * 2 + 2), kEmpty);
  JoinedPoints points;
  points.of_vertex.resize(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    const auto k = key(v);
    std::uint64_t h = k[0] * 0x9E3779B97F4A7C15ULL;
    h = (h ^ h >> 32 ^ k[1]) * 0xD6E8FEB86659FD93ULL;
    h = (h ^ h >> 32 ^ k[2]) * 0x9E3779B97F4A7C15ULL;
    std::size_t at = static_cast<std::size_t>(h ^ h >> 32) & (slots.size() - 1);
    while (slots[at] != kEmpty && key(slots[at]) != k) at = (at + 1) & (slots.size() - 1);
    if (slots[at] == kEmpty) {
      slots[at] = v;
      points.of_vertex[v] = static_cast<std::uint32_t>(points.count++);
    } else {
      points.of_vertex[v] = points.of_vertex[slots[at]];
    }
  }
  return points;
}

}  // namespace rastrum
