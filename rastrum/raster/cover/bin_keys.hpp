// SPDX-License-Identifier: BSD-3-Clause
// The keys of a thread's bin: plain maxima, with bounds of what is hidden (hierarchical Z), so that
// pieces and blocks behind them are left out before they are covered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/raster/context/counters.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/surface_view.hpp>

namespace rastrum::raster {

class BinKeys {
 public:
  /// Raises `surface`, which has what was drawn before in `rect`, a bin or a part of one. `hides`:
  /// keeps bounds. `rows`: memory for the rows of small triangles, which reach the surface by
  /// finish(); null: none.
  void begin(const Kernels& kernel, const SurfaceView& surface, Rect rect, bool hides,
             RowKeys* rows = nullptr);

  /// No mask is empty or reaches outside of the image.
  void blocks(const Piece* pieces, std::span<const Block> blocks);
  /// Fragments with known keys, by their places in the bin.
  void fragments(std::span<const BinFragment> fragments);
  [[nodiscard]] RowKeys* rows() const { return rows_; }
  /// Updates bounds after a kernel raised the rows. Returns the number of samples covered.
  std::uint64_t rows_raised();
  /// Nothing more is drawn: moves all keys to the surface.
  void finish() {
    if (rows_ != nullptr) take_rows();
  }
  /// Notes that a kernel has raised the surface's keys.
  void raised(const RaisedKeys& raised);
  [[nodiscard]] const SurfaceView& surface() const { return surface_; }
  /// Counts pieces that the caller left out.
  void hid_pieces(std::uint64_t n) { bounds_.hidden_pieces += n; }

  /// Null: no bounds are kept.
  [[nodiscard]] DepthBounds* bounds() { return is_bounded_ ? &bounds_ : nullptr; }
  /// Updates all bounds from all keys. Worth it where much may be hidden.
  void find_bounds();
  /// Adds "hidden pieces" and "hidden blocks" since the last call.
  void collect(Counters& counters);

 private:
  void take_rows();
  /// The first key of a block in the rows.
  [[nodiscard]] std::uint64_t* rows_of(int bx, int by) const;
  void raise_bounds(const Piece* pieces, std::span<const Block> blocks);
  void look(int i);
  void find_least();

  const Kernels* kernel_ = nullptr;
  SurfaceView surface_;
  RowKeys* rows_ = nullptr;
  Rect rect_;
  DepthBounds bounds_;
  std::uint32_t unseen_[kBlocksPerBin] = {};
  bool is_bounded_ = false;
};

}  // namespace rastrum::raster
