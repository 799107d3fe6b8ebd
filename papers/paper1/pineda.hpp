// SPDX-License-Identifier: BSD-3-Clause
// pineda: tests edge functions in a hierarchy of tiles and draws directly into the whole frame
// (paper 1, section 3.1.3 and `triangle_imm_pineda.fut`; Pineda, 1988). Small triangles are
// separated first: for them bins cost more than they save.
//
// Deviations. The last stage is a block with a mask instead of single pixels: a region takes masks,
// so pixels are never stored. Small triangles go through the blocks of their boxes instead of one
// mask over 128 candidates.
#pragma once

#include <memory>

#include <papers/axes/coverage.hpp>

namespace rastrum::family {

/// Work O(pieces + boxes' bins · tiles a bin + blocks), span O(tiles a bin + log). 16 bytes and a
/// mask a bin, in turns below FrameContext::expansion_bytes. Counters: "small", "large", "bins",
/// "tile pairs". Throws Error{invalid_argument} for invalid sizes.
[[nodiscard]] std::unique_ptr<Coverage> make_pineda(const Tuning& tuning, MemoryAccount& memory);

}  // namespace rastrum::family
