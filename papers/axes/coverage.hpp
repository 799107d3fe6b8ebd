// SPDX-License-Identifier: BSD-3-Clause
// The first axis of the family (papers/README.md): how the samples that pieces cover are
// enumerated. A coverage draws a range of triangles into the frame, by draw_shared where all
// threads share the picture or by draw_tiles where a thread owns a tile; which visibility resolves
// the fragments is none of its business.
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
  /// Draws triangles [first, last) of the frame's numbering. Names its work in frame.counters.
  virtual void draw(Frame& frame, std::uint64_t first, std::uint64_t last) = 0;
};

/// A row of the table: a way to enumerate.
struct CoverageRow {
  std::string_view name, description;
  bool owns_tiles = false;  ///< needs no surface for the frame: everything goes through draw_tiles
  /// Expands triangles to rows, bins or pairs; keeps them below FrameContext::expansion_bytes
  /// itself.
  bool expands = false;
  /// Bytes of scratch a triangle, beside what it is expanded to, for cutting a frame into batches.
  int triangle_bytes = 96;
  /// Throws Error{invalid_argument} for a tuning that it does not take, saying which it does.
  std::unique_ptr<Coverage> (*make)(const Tuning&, MemoryAccount&) = nullptr;
};

/// All rows.
[[nodiscard]] std::span<const CoverageRow> coverages() noexcept;

}  // namespace rastrum::family
