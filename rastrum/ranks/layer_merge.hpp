// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rastrum/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/shared_layers.hpp>
#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::ranks {

/// Merges the packed fragments (FragmentBytes) of all ranks, block by block, and blends them by the
/// exact method of one renderer: nearest first, at equal depths the earlier part first. Appends the
/// bytes of a SeenBlock per block, in rising order. `threads` may be null.
struct LayerMerge {
  Isa isa;
  float opaque_at;
  int samples;

  void blend(const BlockGrid& grid, const Mail& mail, parallel::Threads* threads, Bytes& to) const;
  /// The same for fragments in shared memory, for blocks that no other rank takes. Results go to
  /// SharedLayers::put or, if it is not null, into `picture`, which also gets the blocks without
  /// layers.
  void blend(const BlockGrid& grid, SharedLayers layers, parallel::Threads* threads,
             RootPicture* picture) const;
};

/// The blended layers of a block, and the pixels that have some. With several samples per pixel,
/// `seen` is final: the mean over the samples, including what is behind the layers. As bytes: the
/// mask, then a SeenPixel for each of its pixels.
struct SeenBlock {
  BlockMask where;
  transparency::Seen seen;
};
[[nodiscard]] SeenBlock take_seen(Reader from);
[[nodiscard]] std::size_t seen_bytes(std::uint64_t mask);

}  // namespace rastrum::ranks
