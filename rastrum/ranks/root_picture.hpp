// The root's picture where layers are: what owners of blocks have seen of these, over the opaque
// colours of who has won, over the background.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/shared_layers.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/shade/color.hpp>

namespace rastrum::ranks {

struct SeenBlock;

class RootPicture {
 public:
  /// `request`: of size, background and targets of colours alone. `threads` may be null.
  RootPicture(const BlockGrid& grid, const raster::FrameRequest& request,
              parallel::Threads* threads);
  /// Of opaque surfaces: masks, and of each pixel the premultiplied colour.
  void take_behind(Reader from);
  /// Stores what was seen of blocks that lie in `mail`, each there once (LayerMerge).
  void take_seen(const Mail& mail);
  /// The same of those that ranks share.
  void take_seen(SharedLayers layers);
  /// Stores the blocks that will have none.
  void store_rest(SharedLayers layers);
  /// The same of one block, with what is seen of it or without, by any thread: each block by one.
  void take_block(const SeenBlock& block);
  void store_behind(std::size_t block);
  /// Stores the blocks that have had none.
  void finish();

 private:
  template <class F>
  void store_all_behind(const F& where);
  void store(std::uint32_t block, std::uint64_t mask, const raster::BlockColors& colors) const;
  template <class F>
  void for_each(std::size_t n, const F& f) const;

  const BlockGrid& grid_;
  raster::FrameRequest request_;
  raster::Backdrop backdrop_;
  parallel::Threads* threads_;
  std::vector<std::uint64_t> masks_;  ///< by block: where something is behind
  std::vector<std::unique_ptr<raster::BlockColors>> behind_;
  std::vector<std::uint8_t> stored_;
};

}  // namespace rastrum::ranks
