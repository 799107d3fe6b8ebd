// SPDX-License-Identifier: BSD-3-Clause
// A map's colours under the light of its cells, both stretched to the size of the finer one. The
// light is one number, or one per channel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::terrain {

/// A mix of cells `a` and `b`, with `share` of `b`.
struct Tap {
  int a = 0, b = 0;
  float share = 0;
};

/// An axis scaled from `from` to `to` cells: for each the cell that it lies in or, if `smooth`, the
/// two between whose centres it lies.
[[nodiscard]] inline std::vector<Tap> scaled_taps(int from, int to, bool smooth, Tiling tiling) {
  std::vector<Tap> taps(static_cast<std::size_t>(to));
  for (std::int64_t i = 0; i < to; ++i) {
    Tap& tap = taps[static_cast<std::size_t>(i)];
    // The centre in cells of `from`, less one half, times 2 · to: exact, so equal sizes change
    // nothing.
    const std::int64_t at = (2 * i + 1) * from - to, unit = std::int64_t{2} * to;
    const std::int64_t below = (at + unit) / unit - 1;  // at > −unit: the floor
    if (smooth) {
      tap = {static_cast<int>(tiled(below, from, tiling)),
             static_cast<int>(tiled(below + 1, from, tiling)),
             static_cast<float>(at - below * unit) / static_cast<float>(unit)};
    } else {
      tap.a = tap.b = static_cast<int>(i * from / to);
    }
  }
  return taps;
}

[[nodiscard]] inline float mix(float a, float b, float share) {
  return a + share * (b - a);
}
[[nodiscard]] inline Vec3 mix(Vec3 a, Vec3 b, float share) {
  return {mix(a.x, b.x, share), mix(a.y, b.y, share), mix(a.z, b.z, share)};
}
[[nodiscard]] inline Rgba8 mix(Rgba8 a, Rgba8 b, float share) {
  const auto channel = [share](std::uint8_t u, std::uint8_t v) {
    return static_cast<std::uint8_t>(mix(static_cast<float>(u), static_cast<float>(v), share) +
                                     0.5F);
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b), channel(a.a, b.a)};
}

template <class T>
[[nodiscard]] std::remove_const_t<T> between(const ImageView<T>& image, const Tap& x,
                                             const Tap& y) {
  if (x.share == 0 && y.share == 0) return image(x.a, y.a);
  return mix(mix(image(x.a, y.a), image(x.b, y.a), x.share),
             mix(image(x.a, y.b), image(x.b, y.b), x.share), y.share);
}

/// lit(colour, light) at each texel of the finer image. `threads` may be null.
template <class Light, class Lit>
[[nodiscard]] Image<Rgba8> under_light(const Image<Rgba8>& colors, const Image<Light>& light,
                                       bool smooth, Tiling tiling, const Lit& lit,
                                       parallel::Threads* threads) {
  Image<Rgba8> out(std::max(colors.width(), light.width()),
                   std::max(colors.height(), light.height()));
  const auto taps = [&](int from, int to) { return scaled_taps(from, to, smooth, tiling); };
  const std::vector<Tap> color_x = taps(colors.width(), out.width()),
                         color_y = taps(colors.height(), out.height()),
                         light_x = taps(light.width(), out.width()),
                         light_y = taps(light.height(), out.height());
  const auto fill = [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < out.width(); ++x) {
      const auto column = static_cast<std::size_t>(x);
      out(x, y) = lit(between(colors.view(), color_x[column], color_y[row]),
                      between(light.view(), light_x[column], light_y[row]));
    }
  };
  parallel::for_each_index(threads, static_cast<std::size_t>(out.height()), fill, 8);
  return out;
}

}  // namespace rastrum::terrain
