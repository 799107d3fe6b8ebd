// SPDX-License-Identifier: BSD-3-Clause
#include <papers/table/layers.hpp>

#include <papers/axes/one_pass.hpp>
#include <rastrum/transparency/layers.hpp>

namespace rastrum::family {
namespace {

class LayersRegion final : public OnePassRegion {
 public:
  explicit LayersRegion(MemoryAccount& memory) : bin_(memory) {}

  void begin(const RegionContext& context, const SurfaceView& surface, Rect rect,
             std::size_t chunks) override {
    restart(chunks);
    bin_.begin(context, surface, rect);
  }
  std::optional<Pass> next() override {
    const auto pass = OnePassRegion::next();
    if (!pass) bin_.finish();
    return pass;
  }
  void blocks(std::size_t, const Piece* pieces, std::span<const Block> blocks) override {
    bin_.blocks(pieces, blocks);
  }
  void fragments(std::span<const BinFragment> fragments) override { bin_.fragments(fragments); }
  DepthBounds* bounds() override { return bin_.bounds(); }
  void collect(Counters& counters) override { bin_.collect(counters); }

 private:
  transparency::LayeredBin bin_;
};

std::unique_ptr<Region> make_layers(Sharing, MemoryAccount& memory) {
  return std::make_unique<LayersRegion>(memory);
}

}  // namespace

const Visibility& layers() noexcept {
  static constexpr Visibility kRow{
      "layers", "all fragments of a pixel in order, for transparency", true, true, 0, make_layers,
      true};
  return kRow;
}

}  // namespace rastrum::family
