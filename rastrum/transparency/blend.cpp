// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transparency/blend.hpp>

#include <algorithm>

#include <rastrum/raster/context/added_transparency.hpp>
#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::transparency {
namespace {

using raster::BlockColors;

class FrontToBack final : public LayerBlend {
 public:
  FrontToBack(float alpha_threshold, Isa isa)
      : kernel_(blend_kernels(isa)),
        packed_(packed_kernels(isa)),
        opaque_at_(1 - alpha_threshold) {}

  [[nodiscard]] LayerOrder order() const override { return LayerOrder::depth; }
  [[nodiscard]] float opaque_at() const override { return opaque_at_; }
  void begin(const BlockColors& behind) override {
    behind_ = &behind;
    for (float(&channel)[64] :
         {std::ref(seen_.r), std::ref(seen_.g), std::ref(seen_.b), std::ref(seen_.a)})
      std::fill_n(channel, 64, 0.0F);
    std::fill_n(seen_.through, 64, 1.0F);
  }
  std::uint64_t layer(const Layer& l) override {
    return kernel_.behind(l.colors, l.mask, opaque_at_, seen_);
  }
  bool row(const PackedRow& row, std::size_t first) override {
    packed_.behind(row, first, opaque_at_, seen_);
    return true;
  }
  bool block(const PackedRow (&rows)[8], const BlockColors* behind, BlockColors& out) override {
    packed_.over(rows, behind, opaque_at_, out);
    return true;
  }
  void finish(BlockColors& out) override { kernel_.finish(seen_, *behind_, out); }

 private:
  const BlendKernels& kernel_;
  const PackedKernels& packed_;
  const float opaque_at_;
  const BlockColors* behind_ = nullptr;
  Seen seen_;
};

/// Each layer over the earlier ones, as a GPU blends without sorting.
class AsSubmitted final : public LayerBlend {
 public:
  explicit AsSubmitted(Isa isa) : kernel_(blend_kernels(isa)), packed_(packed_kernels(isa)) {}

  void begin(const BlockColors& behind) override { colors_ = behind; }
  std::uint64_t layer(const Layer& l) override {
    kernel_.before(l.colors, l.mask, colors_);
    return 0;
  }
  bool row(const PackedRow& row, std::size_t first) override {
    packed_.before(row, first, colors_);
    return true;
  }
  bool block(const PackedRow (&rows)[8], const BlockColors* behind, BlockColors& out) override {
    out = behind == nullptr ? BlockColors{} : *behind;
    for (std::size_t y = 0; y < 8; ++y) packed_.before(rows[y], y * 8, out);
    return true;
  }
  void finish(BlockColors& out) override { out = colors_; }

 private:
  const BlendKernels& kernel_;
  const PackedKernels& packed_;
  BlockColors colors_;
};

}  // namespace

std::unique_ptr<LayerBlend> make_exact_blend(const TransparencyOptions& options, Isa isa) {
  return std::make_unique<FrontToBack>(options.alpha_threshold, isa);
}

std::unique_ptr<LayerBlend> make_blend(const TransparencyOptions& options, Isa isa) {
  if (options.method == Transparency::added) return options.added->make(options, isa);
  if (options.method == Transparency::unsorted) return std::make_unique<AsSubmitted>(isa);
  return make_exact_blend(options, isa);
}

}  // namespace rastrum::transparency
