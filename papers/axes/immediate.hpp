// SPDX-License-Identifier: BSD-3-Clause
// Shared by the coverages that draw directly into the whole frame: picks the pieces of a batch by
// index, and hands results of an expansion on as blocks without storing them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <papers/axes/frame.hpp>
#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/masked_expansion.hpp>
#include <rastrum/parallel/partition.hpp>

namespace rastrum::family {

/// Results of a chunk: few enough that small frames divide among threads, enough that the cost of a
/// chunk's binary search and task vanishes.
inline constexpr std::size_t kResultsPerChunk = 1024;

/// Draws the results of an expansion of `in`: emit(in[i], j, emitter) adds the blocks of result j.
/// Chunk c of the expansion is chunk c of the region and is the same in every pass.
template <class Expansion, class Chunk, class In, class Emit>
void draw_chunks(Frame& frame, const Piece* pieces, const Expansion& expansion, const In& in,
                 const Emit& emit) {
  draw_shared(frame, expansion.chunks(), [&](std::size_t c, Emitter& emitter) {
    emitter.use(pieces);
    Chunk(expansion, in, c).each([&](const auto& x, std::size_t j) { emit(x, j, emitter); });
  });
}
template <class In, class Emit>
void draw_expanded(Frame& frame, const Piece* pieces, const parallel::Expansion& expansion,
                   const In& in, const Emit& emit) {
  draw_chunks<parallel::Expansion, parallel::ExpansionChunk<In>>(frame, pieces, expansion, in,
                                                                 emit);
}
template <int kBits, class In, class Emit>
void draw_expanded(Frame& frame, const Piece* pieces,
                   const parallel::MaskedExpansion<kBits>& expansion, const In& in,
                   const Emit& emit) {
  draw_chunks<parallel::MaskedExpansion<kBits>, parallel::MaskedChunk<kBits, In>>(
      frame, pieces, expansion, in, emit);
}

/// The indices of the pieces that may have a sample in the frame's view. If the view is a band, the
/// batch has other pieces too. Work O(n); 4 bytes a piece.
[[nodiscard]] parallel::Buffer<std::uint32_t> pieces_in_view(Frame& frame,
                                                             std::span<const Piece> pieces);

/// The same, small pieces first: those whose box in the view has at most Tuning::small_px pixels
/// (0: 128, paper 1, table 5). Counts "small" and "large".
[[nodiscard]] parallel::Partition<std::uint32_t> small_pieces_first(Frame& frame,
                                                                    std::span<const Piece> pieces);

/// Draws small pieces directly: expands each to the blocks that its box touches. Work O(pieces +
/// blocks), 8 bytes a piece.
void draw_box_blocks(Frame& frame, const Piece* pieces, std::span<const std::uint32_t> which);

}  // namespace rastrum::family
