// SPDX-License-Identifier: BSD-3-Clause
// The pieces of many triangles in one array, for coverages that index them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <papers/axes/frame.hpp>
#include <rastrum/raster/setup/set_up.hpp>

namespace rastrum::family {

/// Sets up triangles with all threads and counts them in the frame's statistics. Memory: twice the
/// pieces. Throws Error{invalid_argument}, which names an index that is out of range.
class PieceArray {
 public:
  explicit PieceArray(MemoryAccount& memory) : memory_(memory), pieces_(memory) {}
  /// Valid until the next call.
  std::span<const Piece> fill(Frame& frame, std::uint64_t first, std::uint64_t last);

 private:
  MemoryAccount& memory_;
  ScratchBuffer<Piece> pieces_;
  std::vector<Pieces> groups_;
};

}  // namespace rastrum::family
