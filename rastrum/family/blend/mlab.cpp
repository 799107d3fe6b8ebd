// Multi-layer alpha blending (Salvi and Vaidyanathan, I3D 2014): a pixel keeps four layers sorted
// by depth; a fifth makes the last two become one. So it depends on the order of submission where
// more than four surfaces overlap.
#include <bit>

#include <rastrum/family/blend/approximations.hpp>

namespace rastrum::family {
namespace {

using raster::BlockColors;

constexpr int kLayers = 4;

/// Premultiplied colour, and how much is seen through it.
struct Blended {
  std::uint64_t key = 0;
  float r = 0, g = 0, b = 0, through = 1;

  void put_before(const Blended& o) {
    r += through * o.r;
    g += through * o.g;
    b += through * o.b;
    through *= o.through;
  }
};

class MultiLayer final : public LayerBlend {
 public:
  void begin(const BlockColors& behind) override {
    behind_ = &behind;
    for (auto& pixel : pixels_)
      for (Blended& layer : pixel) layer = {};
  }
  std::uint64_t layer(const Layer& l) override {
    for (std::uint64_t m = l.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      Blended(&kept)[kLayers] = pixels_[i];
      Blended fragment{l.keys[i], l.colors.r[i], l.colors.g[i], l.colors.b[i], 1 - l.colors.a[i]};
      // What is not taken goes on to the next place; empty ones have key 0.
      for (Blended& place : kept)
        if (fragment.key > place.key) std::swap(fragment, place);
      kept[kLayers - 1].put_before(fragment);
    }
    return 0;
  }
  void finish(BlockColors& out) override {
    for (int i = 0; i < 64; ++i) {
      Blended all;
      for (const Blended& layer : pixels_[i]) all.put_before(layer);
      out.r[i] = all.r + all.through * behind_->r[i];
      out.g[i] = all.g + all.through * behind_->g[i];
      out.b[i] = all.b + all.through * behind_->b[i];
      out.a[i] = 1 - all.through * (1 - behind_->a[i]);
    }
  }

 private:
  const BlockColors* behind_ = nullptr;
  Blended pixels_[64][kLayers];
};

}  // namespace

std::unique_ptr<LayerBlend> make_mlab4() {
  return std::make_unique<MultiLayer>();
}

}  // namespace rastrum::family
