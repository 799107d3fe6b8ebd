// SPDX-License-Identifier: BSD-3-Clause
// grouped: the tiled rasterizer (paper 1, section 3.3; sort-middle after Molnar et al., 1994) as a
// CPU likes it. Triangles are set up in groups whose pieces stay in a core's cache, (bin, piece)
// pairs are sorted by bin inside each group, and a thread that owns a bin walks the groups.
//
// Deviations from the paper. The sort is a counting sort inside each group: no global sort, no
// barrier beyond one. Bins are 64² px of 8² blocks. Micro triangles become fragments in setup,
// where the visibility takes them (docs/decisions/0104).
#pragma once

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(triangles + (bin, piece) pairs + blocks); memory 48 bytes a drawn triangle, 8 a pair, 16
/// a fragment of a micro triangle. Counters: "bins" (pairs), "micro fragments".
[[nodiscard]] std::unique_ptr<Coverage> make_grouped(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
