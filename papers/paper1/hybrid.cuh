// SPDX-License-Identifier: BSD-3-Clause
// hybrid on a device (hybrid.hpp; paper 1, sections 3.3 and 4.2).
#pragma once

#include <span>

#include <papers/paper1/scanline.cuh>
#include <papers/paper1/tiled.cuh>

namespace rastrum::family {

/// Work: `pineda`'s (or `scanline`'s) for small pieces, `tiled`'s for the others. Counters:
/// "small", "large", "bins", "tile pairs" (and "rows", "runs").
template <class Exec>
void draw_hybrid(FamilyFrame<Exec>& frame, std::span<const Piece> pieces) {
  const auto parted = small_pieces_first(frame, pieces);
  const std::span<const std::uint32_t> all = parallel::view_of(parted.elements);
  const std::span<const std::uint32_t> small = all.first(parted.first_count);
  if (frame.tuning.small_path == SmallPath::rows)
    draw_scanlines(frame, pieces, small);
  else
    draw_box_blocks(frame, pieces, small);
  draw_sorted_tiles(frame, pieces, all.subspan(parted.first_count));
}

}  // namespace rastrum::family
