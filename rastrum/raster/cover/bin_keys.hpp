// The keys of a bin that a thread owns: plain maxima, and beside them what is hidden by now
// (hierarchical Z), so that pieces and blocks behind it are left out before they are covered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/raster/frame/counters.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/surface.hpp>

namespace rastrum::raster {

class BinKeys {
 public:
  /// `surface` holds what was drawn before in `rect`, a bin or a part of one, and is raised.
  /// `hides`: bounds are kept.
  void begin(const Kernels& kernel, const SurfaceView& surface, Rect rect, bool hides);

  /// No mask is empty and none reaches outside of the image.
  void blocks(const Piece* pieces, std::span<const Block> blocks);
  /// Fragments whose key is known already, by their places in the bin.
  void fragments(std::span<const BinFragment> fragments);
  /// What a kernel has raised the surface's keys by.
  void raised(const RaisedKeys& raised);
  [[nodiscard]] const SurfaceView& surface() const { return surface_; }
  /// Counts pieces that who draws has left out.
  void hid_pieces(std::uint64_t n) { bounds_.hidden_pieces += n; }

  /// Null where nothing is known.
  [[nodiscard]] DepthBounds* bounds() { return is_bounded_ ? &bounds_ : nullptr; }
  /// Brings them up to date. Costs a look at all keys: for where much may be hidden.
  void find_bounds();
  /// Adds "hidden pieces" and "hidden blocks" since the last call.
  void collect(Counters& counters);

 private:
  void raise_bounds(const Piece* pieces, std::span<const Block> blocks);
  void look(int i);
  void find_least();

  const Kernels* kernel_ = nullptr;
  SurfaceView surface_;
  DepthBounds bounds_;
  std::uint32_t unseen_[kBlocksPerBin] = {};
  bool is_bounded_ = false;
};

}  // namespace rastrum::raster
