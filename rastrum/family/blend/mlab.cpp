// Multi-layer alpha blending (Salvi and Vaidyanathan, I3D 2014): a pixel keeps four layers sorted
// by depth; a fifth makes the last two become one. So it depends on the order of submission where
// more than four surfaces overlap.
#include <rastrum/family/blend/approximation_kernels.hpp>
#include <rastrum/family/blend/approximations.hpp>

namespace rastrum::family {
namespace {

using raster::BlockColors;

class MultiLayer final : public LayerBlend {
 public:
  explicit MultiLayer(Isa isa) : kernel_(approximation_kernels(isa).mlab4) {}

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
  const MultiLayerKernels& kernel_;
  const BlockColors* behind_ = nullptr;
  MultiLayerBlock block_;
};

}  // namespace

std::unique_ptr<LayerBlend> make_mlab4(Isa isa) {
  return std::make_unique<MultiLayer>(isa);
}

}  // namespace rastrum::family
