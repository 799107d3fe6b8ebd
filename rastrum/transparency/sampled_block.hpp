// SPDX-License-Identifier: BSD-3-Clause
// A block with several samples per pixel (anti-aliasing, paper 4's future work). Pieces are moved
// to each sample (raster/rules/samples.hpp), which has its own order of fragments and its own
// opaque surface. A triangle has one colour and one fragment test in a pixel: at the centre if it
// covers that, else at the first sample that it covers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/frame/frame_run.hpp>
#include <rastrum/transparency/blend.hpp>
#include <rastrum/transparency/layer_lists.hpp>
#include <rastrum/transparency/records.hpp>
#include <rastrum/transparency/sampled_layers.hpp>

namespace rastrum::transparency {

struct LayerCounts {
  std::uint64_t fragments = 0, deepest = 0, windows = 0;
  std::uint64_t misplaced = 0;  ///< mask of pixels

  void add(const LayerCounts& o) {
    fragments += o.fragments;
    deepest = std::max(deepest, o.deepest);
    windows += o.windows;
    misplaced |= o.misplaced;
  }
};

class SampledBlock {
 public:
  explicit SampledBlock(MemoryAccount& memory)
      : triangles_(memory), order_(memory), colors_(memory), lists_(memory), layers_(memory) {}

  /// Sets the block's colours (the mean over the samples, premultiplied) and keys (the largest).
  /// Reorders `records`. `filter` and `planes` as in LayerLists::restart; `repair`: sort what the
  /// filter misplaced. Memory: 16 bytes per shaded fragment, at most as much as `planes`: else the
  /// pixels are blended in parts. 14 bytes per fragment of a sample and 8 bytes per pixel and
  /// layer; or, if that exceeds `planes`, 12 of these, one sample after the other.
  LayerCounts resolve(const raster::BinContext& context, const raster::Shading& shading,
                      LayerBlend& blend, std::span<Record> records, int bx, int by,
                      std::size_t filter, std::size_t planes, bool repair, std::uint64_t* keys,
                      raster::BlockColors& out);

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// One triangle, or one side of a quadric, at all samples of the block.
  struct Triangle {
    std::uint32_t first, end;
    std::uint64_t kept;   ///< pixels that the fragment test leaves
    std::uint64_t shown;  ///< pixels where a sample may show it
    std::uint32_t color;  ///< in colors_, of the first pixel of shown(t)
  };
  /// The places at which a triangle's pixels are shaded.
  struct Shaded {
    alignas(64) std::uint64_t keys[64];
    raster::ShadingPoints points;
    std::uint64_t mask = 0;
  };

  void find_triangles();
  void order_triangles();
  void test();
  template <class F>
  void for_each_piece_at_centre(const raster::Piece& piece, F&& f);
  void find_points(const Triangle& t, Shaded& out);
  void raise_opaque();
  void find_shown();
  void blend_pixels(std::uint64_t pixels, LayerCounts& counts, raster::BlockColors& out);
  [[nodiscard]] std::size_t count_shown() const;
  void shade(std::size_t count);
  void flush(Shaded& plane);
  [[nodiscard]] std::uint64_t shown(const Triangle& t) const { return t.shown & pixels_; }
  /// The index of pixel i of shown(t) in colors_.
  [[nodiscard]] std::uint32_t place_of(const Triangle& t, int i) const {
    const std::uint64_t before = shown(t) & ((std::uint64_t{1} << i) - 1);
    return t.color + static_cast<std::uint32_t>(parallel::popcount(before));
  }
  [[nodiscard]] const Vec4& color(std::uint32_t triangle, int i) const {
    return colors_[place_of(triangles_[triangle], i)];
  }
  /// False if a sample has no opaque surface.
  [[nodiscard]] bool find_behind(std::uint32_t sample, raster::BlockColors& behind) const;
  [[nodiscard]] bool deal();
  [[nodiscard]] bool blend_dealt(raster::BlockColors& sum);
  LayerCounts blend_sample(std::uint32_t sample, raster::BlockColors& out);
  [[nodiscard]] bool is_translucent(const Triangle& t) const {
    return context_->request->transparency.method != Transparency::none &&
           (records_[t.first].piece->flags & kTranslucent) != 0;
  }
  /// Calls f(sample, mask, keys) for the parts of `pixels` that a triangle covers, at one sample or
  /// each. f may remove pixels for later samples.
  template <class F>
  void for_each_record(const Triangle& t, const std::uint64_t& pixels,
                       std::optional<std::uint32_t> only, F&& f);

  const raster::BinContext* context_ = nullptr;
  raster::Shading shading_;  ///< empty: no colour is wanted
  LayerBlend* blend_ = nullptr;
  std::span<Record> records_;
  int bx_ = 0, by_ = 0;
  std::size_t filter_ = 0, planes_ = 0;
  bool repair_ = false;
  std::uint64_t pixels_ = 0;  ///< now being blended

  ScratchBuffer<Triangle> triangles_;
  std::uint32_t triangle_count_ = 0;
  ScratchBuffer<std::uint64_t> order_;  ///< triangles in the order of insertion, in the low half
  ScratchBuffer<Vec4> colors_;          ///< the first is 0, of no fragment
  std::uint32_t color_count_ = 0;
  std::vector<std::uint32_t> plane_triangles_;  ///< with fragments to be shaded
  LayerLists<std::uint32_t> lists_;             ///< owner: the triangle
  SampledLayers layers_;
  bool has_opaque_ = false;  ///< else no key is behind an opaque one
  std::uint64_t opaque_[raster::kMaxSamples][64];
  std::uint32_t owner_[raster::kMaxSamples][64];  ///< of the opaque key
  std::uint64_t nearest_[64];
};

}  // namespace rastrum::transparency
