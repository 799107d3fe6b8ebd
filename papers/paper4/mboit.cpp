// SPDX-License-Identifier: BSD-3-Clause
// Moment-based transparency (Münstermann et al., I3D 2018): one pass sums power moments of the
// absorbance −log(1 − α) over depth. A second weights each fragment with the transmittance at its
// depth that the moments imply (moments.inl), in float32 with the paper's biases.
//
// Deviation: a pass before them finds the depth range of the block, and depths are warped
// logarithmically to [−1, 1] over it, not over the range of the frame.
#include <papers/paper4/approximation_kernels.hpp>
#include <papers/paper4/approximations.hpp>

namespace rastrum::family {
namespace {

using raster::BlockColors;

class MomentBased final : public LayerBlend {
 public:
  explicit MomentBased(const MomentKernels& kernel) : kernel_(kernel) {}

  /// Depths, moments, weights.
  [[nodiscard]] int passes() const override { return 3; }
  void begin(const BlockColors& behind) override {
    behind_ = &behind;
    block_.clear();
  }
  void begin_pass(int pass) override {
    pass_ = pass;
    if (pass == 1) block_.set_warp();
  }
  std::uint64_t layer(const Layer& l) override {
    (pass_ == 0   ? kernel_.layer_depths
     : pass_ == 1 ? kernel_.sum_layer
                  : kernel_.weigh_layer)(l, block_);
    return 0;
  }
  /// Sums moments and weighs at once: a row has all fragments of its pixels.
  bool row(const transparency::PackedRow& row, std::size_t first) override {
    if (pass_ == 0) kernel_.row_depths(row, block_);
    if (pass_ == 1) kernel_.row(row, first, block_);
    return true;
  }
  void finish(BlockColors& out) override { kernel_.finish(block_, *behind_, out); }

 private:
  const MomentKernels& kernel_;
  const BlockColors* behind_ = nullptr;
  int pass_ = 0;
  MomentBlock block_;
};

}  // namespace

std::unique_ptr<LayerBlend> make_mboit(int moments, Isa isa) {
  const ApproximationKernels& kernels = approximation_kernels(isa);
  return std::make_unique<MomentBased>(moments == 4 ? kernels.mboit4 : kernels.mboit6);
}

}  // namespace rastrum::family
