// SPDX-License-Identifier: BSD-3-Clause
// How layers of shaded fragments become a block's colours, 64 pixels at a time.
#pragma once

#include <cstdint>
#include <memory>

#include <rastrum/frame.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/transparency/layer_lists.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

namespace rastrum::transparency {

/// At most one fragment per pixel. Pixels outside of `mask` hold anything.
struct Layer {
  const std::uint64_t* keys;
  std::uint64_t mask;
  const raster::BlockColors& colors;  ///< premultiplied
};

/// Per block: begin; for each pass begin_pass and its layers; finish.
class LayerBlend {
 public:
  virtual ~LayerBlend() = default;

  /// The order in which a pixel's fragments arrive.
  [[nodiscard]] virtual LayerOrder order() const { return LayerOrder::submission; }
  /// The number of walks over all layers.
  [[nodiscard]] virtual int passes() const { return 1; }
  /// A pixel is finished if no more than this shows through its layers; 0: never.
  [[nodiscard]] virtual float opaque_at() const { return 0; }
  /// `behind`: the opaque surface, premultiplied; 0 where there is none.
  virtual void begin(const raster::BlockColors& behind) = 0;
  virtual void begin_pass(int /*pass*/) {}
  /// Returns the pixels that no further layer of this pass changes.
  virtual std::uint64_t layer(const Layer& layer) = 0;
  /// Takes all layers of a row of pixels in this pass: elements `first` … of the block. False: it
  /// takes layers only.
  virtual bool row(const PackedRow& /*row*/, std::size_t /*first*/) { return false; }
  /// Blends a whole block into `out`. `behind` may be null: no opaque surface. False: call the
  /// functions above.
  virtual bool block(const PackedRow (&/*rows*/)[8], const raster::BlockColors* /*behind*/,
                     raster::BlockColors& /*out*/) {
    return false;
  }
  /// Premultiplied.
  virtual void finish(raster::BlockColors& out) = 0;
};

/// Blends rows over `behind`, which may be null. `planes` passes the layers of a pass to a blend
/// that takes no rows.
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

[[nodiscard]] std::unique_ptr<LayerBlend> make_exact_blend(const TransparencyOptions& options,
                                                           Isa isa);
[[nodiscard]] std::unique_ptr<LayerBlend> make_blend(const TransparencyOptions& options, Isa isa);

}  // namespace rastrum::transparency
