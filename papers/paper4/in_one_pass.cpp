// SPDX-License-Identifier: BSD-3-Clause
// The approximations that take each fragment once:
//
// Weighted blended transparency (McGuire and Bavoil, JCGT 2013): a weighted mean of all colours
// over the background times the product of the transmittances. The weight is the paper's equation
// 10, α · max(0.01, 3000 (1 − z)³), the one that needs only the window depth z. Depth is reversed
// here, so 1 − z is our depth.
//
// Multi-layer alpha blending (Salvi and Vaidyanathan, I3D 2014): a pixel keeps four layers sorted
// by depth, and a fifth merges the last two. So where more than four surfaces overlap, the result
// depends on the order of submission.
#include <papers/paper4/approximation_kernels.hpp>
#include <papers/paper4/approximations.hpp>

namespace rastrum::family {
namespace {

/// Blends by `Kernels` that gather fragments in a `Block`.
template <class Kernels, class Block>
class InOnePass final : public LayerBlend {
 public:
  explicit InOnePass(const Kernels& kernels) : kernels_(kernels) {}

  void begin(const raster::BlockColors& behind) override {
    behind_ = &behind;
    block_.clear();
  }
  std::uint64_t layer(const Layer& l) override {
    kernels_.layer(l, block_);
    return 0;
  }
  bool row(const transparency::PackedRow& row, std::size_t first) override {
    kernels_.row(row, first, block_);
    return true;
  }
  void finish(raster::BlockColors& out) override { kernels_.finish(block_, *behind_, out); }

 private:
  const Kernels& kernels_;
  const raster::BlockColors* behind_ = nullptr;
  Block block_;
};

}  // namespace

std::unique_ptr<LayerBlend> make_wboit(Isa isa) {
  return std::make_unique<InOnePass<WeightedKernels, WeightedBlock>>(
      approximation_kernels(isa).wboit);
}

std::unique_ptr<LayerBlend> make_mlab4(Isa isa) {
  return std::make_unique<InOnePass<MultiLayerKernels, MultiLayerBlock>>(
      approximation_kernels(isa).mlab4);
}

}  // namespace rastrum::family
