// SPDX-License-Identifier: BSD-3-Clause
// scanline: expands a triangle to its rows and a row to its columns (paper 5, section 3.1,
// algorithm 3a; paper 1, section 3.1, after Henriksen et al., 2019).
//
// Deviations. A row is cut into runs, one for each 8 × 8 block that it crosses, since a region
// resolves blocks. Runs are handed on without being stored; paper 5 stores every fragment. A row's
// interval comes from exact integer edges under the top-left rule (`row_span`), not from rounded
// slopes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(pieces + rows + runs), span O(log (pieces + rows)); 20 bytes a row, in turns below
/// FrameContext::expansion_bytes. Counters: "rows" of the pieces' boxes, "runs".
[[nodiscard]] std::unique_ptr<Coverage> make_scanline(const Tuning& tuning, MemoryAccount& memory);

/// The same for some pieces of a batch.
void draw_scanlines(Frame& frame, const Piece* pieces, std::span<const std::uint32_t> which);

}  // namespace rastrum::family
