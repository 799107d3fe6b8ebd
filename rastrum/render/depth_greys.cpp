#include <rastrum/render/depth_greys.hpp>

#include <algorithm>

#include <rastrum/raster/shade/color.hpp>

namespace rastrum {

void stretch_depth(ImageView<float> depth, Vec4 background, const Targets& targets) {
  float nearest = 0;
  float farthest = 1;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      const float d = depth(x, y);
      if (!(d > 0)) continue;
      nearest = std::max(nearest, d);
      farthest = std::min(farthest, d);
    }
  const float scale = nearest > farthest ? 1 / (nearest - farthest) : 0.0F;
  const Vec4 behind{background.x * background.w, background.y * background.w,
                    background.z * background.w, background.w};
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      const float d = depth(x, y);
      const float grey = 1 - (nearest - d) * scale;
      const Vec4 color = d > 0 ? Vec4{grey, grey, grey, 1} : behind;
      if (!targets.color8.empty()) targets.color8(x, y) = raster::to_straight_rgba8(color);
      if (!targets.color.empty()) targets.color(x, y) = color;
    }
}

}  // namespace rastrum
