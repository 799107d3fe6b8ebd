// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/context/request.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/raster/draws/cut.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::raster {

bool blends(std::span<const Draw> draws, const TransparencyOptions& options) {
  return options.method != Transparency::none && std::ranges::any_of(draws, [](const Draw& d) {
           return (d.any_flags() & kTranslucent) != 0;
         });
}

bool FrameRequest::has_quadrics() const {
  return std::ranges::any_of(draws, [](const Draw& d) { return d.quadrics != nullptr; });
}

bool FrameRequest::has_cuts() const {
  return std::ranges::any_of(draws, [](const Draw& d) { return d.cut != nullptr; });
}

std::uint64_t FrameRequest::kept(const FrameGeometry& frame, const Piece& piece, const Block& block,
                                 const ShadingPoints* points) const noexcept {
  Block nearer = block;
  if ((piece.flags & kOverPicture) != 0)
    for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const int x = block.bx * kBlockSize + i % kBlockSize;
      const int y = block.by * kBlockSize + i / kBlockSize;
      const float behind = targets.depth(x, y);
      // Where nothing is (depth 0) every fragment is drawn, even one of depth 0.
      if (behind > 0 && !(depth_at(piece, x, y) > behind)) nearer.mask ^= std::uint64_t{1} << i;
    }
  if ((piece.flags & kCut) != 0) nearer.mask = in_front(frame, piece, nearer, points);
  if ((piece.flags & kTested) == 0 || nearer.mask == 0) return nearer.mask;
  return test_block(test, frame, piece, nearer, points);
}

}  // namespace rastrum::raster
