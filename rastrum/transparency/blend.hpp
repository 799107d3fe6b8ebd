// SPDX-License-Identifier: BSD-3-Clause
// How the layers of a block become its colours: what a method of transparency does with planes of
// shaded fragments, 64 pixels at a time.
#pragma once

#include <cstdint>
#include <memory>

#include <rastrum/frame.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/transparency/layer_lists.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

namespace rastrum::transparency {

/// A plane of fragments: at most one a pixel. Pixels outside of `mask` hold anything.
struct Layer {
  const std::uint64_t* keys;
  std::uint64_t mask;
  const raster::BlockColors& colors;  ///< premultiplied
};

/// Blends one block after the other. Used: begin; for each pass begin_pass and its layers; finish.
class LayerBlend {
 public:
  virtual ~LayerBlend() = default;

  /// The order in which a pixel's fragments arrive; from layer to layer.
  [[nodiscard]] virtual LayerOrder order() const { return LayerOrder::submission; }
  /// How often it wants to see all layers.
  [[nodiscard]] virtual int passes() const { return 1; }
  /// A pixel is finished where no more than this is seen through its layers; 0: nothing is left
  /// out.
  [[nodiscard]] virtual float opaque_at() const { return 0; }
  /// `behind`: the opaque surface, premultiplied; 0 where there is none.
  virtual void begin(const raster::BlockColors& behind) = 0;
  virtual void begin_pass(int /*pass*/) {}
  /// Returns the pixels that no further layer of this pass changes.
  virtual std::uint64_t layer(const Layer& layer) = 0;
  /// Takes all layers of a row of pixels at once, elements `first` … of the block, in this pass.
  /// False: only layer by layer.
  virtual bool row(const PackedRow& /*row*/, std::size_t /*first*/) { return false; }
  /// Does all of it for a block, whose colours `out` become, in one go: `behind` is null where
  /// there is no opaque surface. False: it has to be asked as above.
  virtual bool block(const PackedRow (&/*rows*/)[8], const raster::BlockColors* /*behind*/,
                     raster::BlockColors& /*out*/) {
    return false;
  }
  /// The block's colours, premultiplied.
  virtual void finish(raster::BlockColors& out) = 0;
};

/// Blends the rows of a block before `behind`, which may be null: nothing. `planes` gives a blend
/// that takes no rows the layers of a pass.
template <class Planes>
void blend_rows(LayerBlend& blend, const PackedRow (&rows)[8], const raster::BlockColors* behind,
                raster::BlockColors& out, Planes&& planes) {
  if (blend.block(rows, behind, out)) return;
  static constexpr raster::BlockColors kNothing{};
  blend.begin(behind == nullptr ? kNothing : *behind);
  for (int pass = 0; pass < blend.passes(); ++pass) {
    blend.begin_pass(pass);
    for (std::size_t y = 0; y < 8; ++y)
      if (!blend.row(rows[y], y * 8)) {
        planes();
        break;
      }
  }
  blend.finish(out);
}

/// Exact blending, without sorting, or what was added.
[[nodiscard]] std::unique_ptr<LayerBlend> make_exact_blend(const TransparencyOptions& options,
                                                           Isa isa);
[[nodiscard]] std::unique_ptr<LayerBlend> make_blend(const TransparencyOptions& options, Isa isa);

}  // namespace rastrum::transparency
