// Weighted blended transparency (McGuire and Bavoil, JCGT 2013): a weighted mean of all colours,
// over what the product of their transmittances leaves of the background. The weight is the paper's
// equation 10, α · max(0.01, 3000 (1 − z)³), the one that reads window depth z alone; depth is
// reversed here, so 1 − z is our depth.
#include <rastrum/family/blend/approximation_kernels.hpp>
#include <rastrum/family/blend/approximations.hpp>

namespace rastrum::family {
namespace {

using raster::BlockColors;

class WeightedBlended final : public LayerBlend {
 public:
  explicit WeightedBlended(Isa isa) : kernel_(approximation_kernels(isa).wboit) {}

  void begin(const BlockColors& behind) override {
    behind_ = &behind;
    block_.clear();
  }
  std::uint64_t layer(const Layer& l) override {
    kernel_.layer(l, block_);
    return 0;
  }
  bool row(const transparency::PackedRow& row, std::size_t first) override {
    kernel_.row(row, first, block_);
    return true;
  }
  void finish(BlockColors& out) override { kernel_.finish(block_, *behind_, out); }

 private:
  const WeightedKernels& kernel_;
  const BlockColors* behind_ = nullptr;
  WeightedBlock block_;
};

}  // namespace

std::unique_ptr<LayerBlend> make_wboit(Isa isa) {
  return std::make_unique<WeightedBlended>(isa);
}

}  // namespace rastrum::family
