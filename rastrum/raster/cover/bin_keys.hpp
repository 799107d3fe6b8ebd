// SPDX-License-Identifier: BSD-3-Clause
// The keys of a bin that a thread owns: plain maxima, and beside them what is hidden by now
// (hierarchical Z), so that pieces and blocks behind it are left out before they are covered.
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
  /// `surface` holds what was drawn before in `rect`, a bin or a part of one, and is raised.
  /// `hides`: bounds are kept. `rows`: memory for the keys of small triangles' rows, which reach
  /// the surface by finish(); null: there are none.
  void begin(const Kernels& kernel, const SurfaceView& surface, Rect rect, bool hides,
             RowKeys* rows = nullptr);

  /// No mask is empty and none reaches outside of the image.
  void blocks(const Piece* pieces, std::span<const Block> blocks);
  /// Fragments whose key is known already, by their places in the bin.
  void fragments(std::span<const BinFragment> fragments);
  /// Where a kernel may put small triangles, or null.
  [[nodiscard]] RowKeys* rows() const { return rows_; }
  /// Looks at what a kernel has raised the rows by; returns how many samples it covered.
  std::uint64_t rows_raised();
  /// Nothing more is drawn: the surface has all keys.
  void finish() {
    if (rows_ != nullptr) take_rows();
  }
  /// Notes that a kernel has raised the surface's keys, and by how much.
  void raised(const RaisedKeys& raised);
  [[nodiscard]] const SurfaceView& surface() const { return surface_; }
  /// Counts pieces that the caller has left out because they are hidden.
  void hid_pieces(std::uint64_t n) { bounds_.hidden_pieces += n; }

  /// Null where nothing is known.
  [[nodiscard]] DepthBounds* bounds() { return is_bounded_ ? &bounds_ : nullptr; }
  /// Brings them up to date. Costs a look at all keys: for where much may be hidden.
  void find_bounds();
  /// Adds "hidden pieces" and "hidden blocks" since the last call.
  void collect(Counters& counters);

 private:
  void take_rows();
  /// Where the keys of a block begin in the rows.
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
