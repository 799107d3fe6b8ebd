// SPDX-License-Identifier: BSD-3-Clause
// pineda: edge functions tested in a hierarchy of tiles, everything drawn at once into the whole
// frame (paper 1, section 3.1.3 and `triangle_imm_pineda.fut`; Pineda, 1988). Small triangles are
// taken apart first: for them bins cost more than they save.
//
// Deviations. Blocks with a mask are the last stage where the paper has single pixels: the fine
// stage's mask is what a region takes, so pixels are never written. Small triangles go through the
// blocks of their boxes instead of one mask over 128 candidates.
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(pieces + boxes' bins · tiles a bin + blocks), span O(tiles a bin + log). 16 bytes and a
/// mask a bin, in turns below FrameContext::expansion_bytes. Counters: "small", "large", "bins",
/// "tile pairs". Throws Error{invalid_argument} for sizes that it does not take.
[[nodiscard]] std::unique_ptr<Coverage> make_pineda(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
