// SPDX-License-Identifier: BSD-3-Clause
// grouped: the tiled rasterizer (paper 1, section 3.3; sort-middle after Molnar et al., 1994) for a
// CPU. Triangles are set up in groups whose pieces stay in a core's cache, (bin, piece) pairs are
// sorted by bin inside each group, and a thread that owns a bin walks the groups.
//
// Deviations from the paper. A counting sort inside each group replaces the global sort, so there
// is one barrier. Bins are 64² px of 8² blocks. Setup turns micro triangles into fragments if the
// visibility takes them (docs/decisions/0104).
#pragma once

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(triangles + (bin, piece) pairs + blocks); memory 48 bytes a drawn triangle, 8 a pair, 16
/// a fragment of a micro triangle. Counters: "bins" (pairs), "micro fragments".
[[nodiscard]] std::unique_ptr<Coverage> make_grouped(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
