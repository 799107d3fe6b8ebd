// SPDX-License-Identifier: BSD-3-Clause
// A program that draws by one of the papers' rasterizers.
#include <cstdio>

#include <rastrum/family.hpp>

int main() {
  rastrum::Renderer renderer = rastrum::family::make_renderer({}, {.rasterizer = "binned"});
  rastrum::Image<rastrum::Rgba8> image(8, 8);
  const rastrum::FrameStats stats =
      renderer.render({}, {}, {.width = 8, .height = 8}, {.color8 = image});
  std::puts(stats.rasterizer.c_str());
  return stats.rasterizer == "binned" ? 0 : 1;
}
