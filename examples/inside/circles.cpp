// SPDX-License-Identifier: BSD-3-Clause
// Circles without a triangle: any field with a sign is rasterized by the same masked expansion
// (paper 1, section 4.4), and each pixel's nearest is found by a histogram of maxima.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/io.hpp>
#include <rastrum/parallel/reduce_by_index.hpp>
#include <rastrum/raster/rules/field.hpp>

struct Circle {
  float x, y, radius;  // px
};

int main() {
  constexpr int kWidth = 960, kHeight = 540;
  std::vector<Circle> circles;  // a sunflower: later circles are nearer
  for (int i = 0; i < 700; ++i) {
    const float turn = 2.39996F * static_cast<float>(i);  // the golden angle
    const float distance = 13 * std::sqrt(static_cast<float>(i));
    circles.push_back({kWidth / 2 + 1.6F * distance * std::cos(turn),
                       kHeight / 2 + distance * std::sin(turn), 4 + 0.03F * static_cast<float>(i)});
  }

  rastrum::parallel::Threads threads;
  const auto pixels = rastrum::raster::field_pixels(
      threads, circles, {0, 0, kWidth, kHeight},
      [](const Circle& c) {
        return rastrum::raster::Rect{static_cast<int>(std::floor(c.x - c.radius)),
                                     static_cast<int>(std::floor(c.y - c.radius)),
                                     static_cast<int>(std::ceil(c.x + c.radius)),
                                     static_cast<int>(std::ceil(c.y + c.radius))};
      },
      [](const Circle& c, float x, float y) { return c.radius - std::hypot(x - c.x, y - c.y); });

  std::vector<std::uint64_t> nearest(std::size_t{kWidth} * kHeight);  // a circle's number + 1
  using rastrum::parallel::Computed;
  rastrum::parallel::reduce_by_index(
      threads, nearest,
      Computed(pixels.size(), [&](std::size_t k) { return pixels[k].y * kWidth + pixels[k].x; }),
      Computed(pixels.size(), [&](std::size_t k) { return std::uint64_t{pixels[k].field} + 1; }),
      rastrum::parallel::Maximum{});

  rastrum::Image<rastrum::Rgba8> image(kWidth, kHeight);
  std::transform(nearest.begin(), nearest.end(), image.pixels().begin(), [](std::uint64_t word) {
    const auto shade = static_cast<std::uint8_t>(word * 255 / 700);
    return word == 0 ? rastrum::Rgba8{250, 248, 240, 255}
                     : rastrum::Rgba8{shade, static_cast<std::uint8_t>(90 + shade / 3),
                                      static_cast<std::uint8_t>(200 - shade / 2), 255};
  });
  rastrum::io::write_png("circles.png", image);
  std::puts("circles.png");
}
