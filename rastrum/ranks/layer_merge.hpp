// What an owner of a block makes of the fragments of all ranks.
#pragma once

#include <rastrum/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/shared_layers.hpp>
#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::ranks {

/// Merges what each rank has packed (FragmentBytes), block by block, and blends it by the exact
/// method of one renderer: the nearest first, of equal depths the part that comes first. Appends
/// each block as SeenBlock has it, in rising order. `threads` may be null.
struct LayerMerge {
  Isa isa;
  float opaque_at;
  int samples;

  void blend(const BlockGrid& grid, const Mail& mail, parallel::Threads* threads, Bytes& to) const;
  /// The same where ranks share what they have packed, of blocks that no other rank takes: to where
  /// they lie, or into `picture` with the blocks that have no layers, where there is one.
  void blend(const BlockGrid& grid, SharedLayers layers, parallel::Threads* threads,
             RootPicture* picture) const;
};

/// What is seen of a block's layers, and where it has some. With several samples it is `seen`
/// alone, the mean of their colours with what is behind them. As bytes: the mask, and of each of
/// its pixels colour and what is seen through it.
struct SeenBlock {
  BlockMask where;
  transparency::Seen seen;
};
[[nodiscard]] SeenBlock take_seen(Reader from);
/// Of its bytes.
[[nodiscard]] std::size_t seen_bytes(std::uint64_t mask);

}  // namespace rastrum::ranks
