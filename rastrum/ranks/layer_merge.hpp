// SPDX-License-Identifier: BSD-3-Clause
// How the owner of a block merges the fragments of all ranks.
#pragma once

#include <rastrum/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/shared_layers.hpp>
#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::ranks {

/// Merges the packed fragments (FragmentBytes) of all ranks, block by block, and blends them by the
/// exact method of one renderer: the nearest first, at equal depths the part that comes first.
/// Appends the bytes of a SeenBlock for each block, in rising order. `threads` may be null.
struct LayerMerge {
  Isa isa;
  float opaque_at;
  int samples;

  void blend(const BlockGrid& grid, const Mail& mail, parallel::Threads* threads, Bytes& to) const;
  /// The same for fragments in shared memory, for the blocks that no other rank takes. The results
  /// go to SharedLayers::put or, if there is one, into `picture`, with the blocks that have no
  /// layers.
  void blend(const BlockGrid& grid, SharedLayers layers, parallel::Threads* threads,
             RootPicture* picture) const;
};

/// The blended layers of a block, and the pixels that have some. With several samples a pixel,
/// `seen` is final: the mean over the samples, with what is behind the layers. As bytes: the mask,
/// then for each of its pixels the colour and what is seen through it.
struct SeenBlock {
  BlockMask where;
  transparency::Seen seen;
};
[[nodiscard]] SeenBlock take_seen(Reader from);
/// The size of a SeenBlock as bytes.
[[nodiscard]] std::size_t seen_bytes(std::uint64_t mask);

}  // namespace rastrum::ranks
