// SPDX-License-Identifier: BSD-3-Clause
// The first axis of the family (papers/README.md): a coverage enumerates the samples that pieces
// cover. It draws a range of triangles into the frame, by draw_shared where all threads share the
// picture, by draw_tiles where a thread owns a tile. It does not know which visibility resolves the
// fragments.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <papers/axes/frame.hpp>

namespace rastrum::family {

class Coverage {
 public:
  virtual ~Coverage() = default;
  /// Draws triangles [first, last) of the frame's numbering. Adds its counters to the frame's.
  virtual void draw(Frame& frame, std::uint64_t first, std::uint64_t last) = 0;
};

/// A row of the table: a coverage.
struct CoverageRow {
  std::string_view name, description;
  bool owns_tiles = false;  ///< needs no surface for the frame: everything goes through draw_tiles
  /// Expands triangles to rows, bins or pairs, and itself keeps them below
  /// FrameContext::expansion_bytes.
  bool expands = false;
  /// Bytes of scratch per triangle, without the expansion. They decide how a frame is cut into
  /// batches.
  int triangle_bytes = 96;
  /// Throws Error{invalid_argument}, which names the valid tunings, for any other.
  std::unique_ptr<Coverage> (*make)(const Tuning&, MemoryAccount&) = nullptr;
};

[[nodiscard]] std::span<const CoverageRow> coverages() noexcept;

}  // namespace rastrum::family
