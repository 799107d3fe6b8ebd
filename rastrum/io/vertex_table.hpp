// SPDX-License-Identifier: BSD-3-Clause
// Makes vertices of the corners of triangles that have no indices.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::io {

/// Vertices by position bits: open addressing over indices into the positions, so an entry costs 4
/// bytes and keys are read in place. `P`: Vec3 or Vec3d.
template <class P>
class VertexTable {
 public:
  /// Borrows both.
  VertexTable(std::vector<P>& positions, std::size_t expected, Budget& budget)
      : positions_(positions), budget_(budget) {
    budget_.resize(slots_, std::bit_ceil(expected * 2 + 16), kEmpty);
    budget_.reserve(positions_, expected);
  }

  std::uint32_t operator()(P p) {
    const Key key = std::bit_cast<Key>(p);
    std::size_t at = hash(key) & (slots_.size() - 1);
    while (slots_[at] != kEmpty) {
      if (std::bit_cast<Key>(positions_[slots_[at]]) == key) return slots_[at];
      at = (at + 1) & (slots_.size() - 1);
    }
    const auto index = static_cast<std::uint32_t>(positions_.size());
    if (index == kEmpty) throw Error(Errc::unsupported, "more than 2³² − 1 distinct vertices");
    slots_[at] = index;
    budget_.add(positions_, p);
    if (positions_.size() * 2 > slots_.size()) grow();
    return index;
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;

  using Key = std::conditional_t<sizeof(P) == 12, std::array<std::uint32_t, 3>,
                                 std::array<std::uint64_t, 3>>;

  static std::size_t hash(const Key& k) {
    std::uint64_t h = (std::uint64_t{k[0]} << 32 ^ k[1]) * 0x9E3779B97F4A7C15ULL;
    h = (h ^ h >> 32 ^ k[2]) * 0xD6E8FEB86659FD93ULL;
    return static_cast<std::size_t>(h ^ h >> 32);
  }

  void grow() {
    std::ranges::fill(slots_, kEmpty);
    budget_.resize(slots_, slots_.size() * 2, kEmpty);
    for (std::uint32_t i = 0; i < positions_.size(); ++i) {
      std::size_t at = hash(std::bit_cast<Key>(positions_[i])) & (slots_.size() - 1);
      while (slots_[at] != kEmpty) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = i;
    }
  }

  std::vector<P>& positions_;
  Budget& budget_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace rastrum::io
