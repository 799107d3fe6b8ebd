// SPDX-License-Identifier: BSD-3-Clause
// The root's picture where layers are: the layers that owners of blocks have blended, over the
// opaque colours of the ranks that have won, over the background.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/shared_layers.hpp>
#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/color.hpp>

namespace rastrum::ranks {

struct SeenBlock;

class RootPicture {
 public:
  /// `request`: its size, background and targets of colours are used. `threads` may be null.
  RootPicture(const BlockGrid& grid, const raster::FrameRequest& request,
              parallel::Threads* threads);
  /// Takes opaque surfaces: masks, and the premultiplied colour of each of their pixels.
  void take_behind(Reader from);
  /// Stores the blended blocks in `mail`, each of which is there once (LayerMerge).
  void take_seen(const Mail& mail);
  /// The same for blocks in shared memory.
  void take_seen(SharedLayers layers);
  /// Stores the blocks that have no layers.
  void store_rest(SharedLayers layers);
  /// Stores one block, with its layers or without. Any thread may call these, one for each block.
  void take_block(const SeenBlock& block);
  void store_behind(std::size_t block);
  /// Stores the blocks that have not been stored.
  void finish();

 private:
  template <class F>
  void store_all_behind(const F& where);
  void store(std::uint32_t block, std::uint64_t mask, const raster::BlockColors& colors) const;

  static constexpr std::size_t kGrain = 32;  ///< blocks that a thread takes at once
  const BlockGrid& grid_;
  raster::FrameRequest request_;
  raster::FramePlan plan_;
  parallel::Threads* threads_;
  std::vector<std::uint64_t> masks_;  ///< by block: where something is behind
  std::vector<std::unique_ptr<raster::BlockColors>> behind_;
  std::vector<std::uint8_t> stored_;
};

}  // namespace rastrum::ranks
