// SPDX-License-Identifier: BSD-3-Clause
// The root's picture of a frame with layers: the owners' blended layers over the winners' opaque
// colours over the background.
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
  /// Uses the request's size, background and colour targets. `threads` may be null.
  RootPicture(const BlockGrid& grid, const raster::FrameRequest& request,
              parallel::Threads* threads);
  /// Takes opaque surfaces: masks with the premultiplied colours of their pixels.
  void take_behind(Reader from);
  /// Stores the blended blocks in `mail`, where each occurs once (LayerMerge).
  void take_seen(const Mail& mail);
  void take_seen(SharedLayers layers);
  /// Stores the blocks without layers.
  void store_rest(SharedLayers layers);
  /// Stores one block, with or without layers. Thread-safe for distinct blocks.
  void take_block(const SeenBlock& block);
  void store_behind(std::size_t block);
  /// Stores the rest.
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
  std::vector<std::uint64_t> masks_;  ///< by block: pixels with something behind
  std::vector<std::unique_ptr<raster::BlockColors>> behind_;
  std::vector<std::uint8_t> stored_;
};

}  // namespace rastrum::ranks
