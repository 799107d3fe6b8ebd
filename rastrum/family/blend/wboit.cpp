// Weighted blended transparency (McGuire and Bavoil, JCGT 2013): a weighted mean of all colours,
// over what the product of their transmittances leaves of the background. The weight is the paper's
// equation 10, α · max(0.01, 3000 (1 − z)³), the one that reads window depth z alone; depth is
// reversed here, so 1 − z is our depth.
#include <algorithm>
#include <bit>

#include <rastrum/family/blend/approximations.hpp>
#include <rastrum/raster/setup/piece.hpp>

namespace rastrum::family {
namespace {

using raster::BlockColors;

class WeightedBlended final : public LayerBlend {
 public:
  void begin(const BlockColors& behind) override {
    behind_ = &behind;
    sum_ = {};
    std::fill_n(through_, 64, 1.0F);
  }
  std::uint64_t layer(const Layer& l) override {
    for (std::uint64_t m = l.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const float alpha = l.colors.a[i];
      const float d =
          std::bit_cast<float>(static_cast<std::uint32_t>(l.keys[i] >> raster::kIdBits));
      const float weight = alpha * std::max(0.01F, 3000 * (d * d * d));
      sum_.r[i] += weight * l.colors.r[i];
      sum_.g[i] += weight * l.colors.g[i];
      sum_.b[i] += weight * l.colors.b[i];
      sum_.a[i] += weight * alpha;
      through_[i] *= 1 - alpha;
    }
    return 0;
  }
  void finish(BlockColors& out) override {
    for (int i = 0; i < 64; ++i) {
      const float through = through_[i];
      const float scale = sum_.a[i] > 0 ? (1 - through) / sum_.a[i] : 0.0F;
      out.r[i] = sum_.r[i] * scale + through * behind_->r[i];
      out.g[i] = sum_.g[i] * scale + through * behind_->g[i];
      out.b[i] = sum_.b[i] * scale + through * behind_->b[i];
      out.a[i] = 1 - through * (1 - behind_->a[i]);
    }
  }

 private:
  const BlockColors* behind_ = nullptr;
  BlockColors sum_;
  float through_[64];
};

}  // namespace

std::unique_ptr<LayerBlend> make_wboit() {
  return std::make_unique<WeightedBlended>();
}

}  // namespace rastrum::family
