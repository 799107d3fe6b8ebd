// SPDX-License-Identifier: BSD-3-Clause
// Camera roll. The picture plane is upright and the view level, so a rolled picture is a rotated
// window of a larger upright one, exactly. The larger picture is sampled: colours bilinearly
// between pixel centres, depth at the nearest pixel. At multiples of 90° both are the pixels
// themselves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/image.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum::terrain {

struct Upright {
  TerrainOptions options;
  TerrainCamera camera;
};
/// The upright picture that holds the rolled one about the same centre. Throws
/// Error{invalid_argument} if it would exceed the largest picture.
[[nodiscard]] Upright upright_of(const TerrainOptions& options, const TerrainCamera& camera);

/// Pixels of a picture rotated counter-clockwise out of an upright one. Kernels copy its sine and
/// cosine, so these are the host's on every device.
class Roll {
 public:
  Roll(double roll_rad, int width, int height);

  struct Position {
    double x, y;  ///< px in the upright picture
  };
  /// A pixel's centre in the upright picture.
  [[nodiscard]] RASTRUM_HD Position position(int upright_width, int upright_height, int x,
                                             int y) const {
    const double dx = x + 0.5 - width_ / 2.0, dy = y + 0.5 - height_ / 2.0;
    return {upright_width / 2.0 + (dx * cos_ - dy * sin_),
            upright_height / 2.0 + (dx * sin_ + dy * cos_)};
  }

  [[nodiscard]] RASTRUM_HD Rgba8 operator()(const ImageView<const Rgba8>& upright, int x,
                                            int y) const {
    const Position at = position(upright.width, upright.height, x, y);
    // In 1/256 px, which undoes the rounding of positions at centres.
    const auto u = static_cast<std::int64_t>(std::floor((at.x - 0.5) * 256 + 0.5));
    const auto v = static_cast<std::int64_t>(std::floor((at.y - 0.5) * 256 + 0.5));
    const auto tx = static_cast<std::uint32_t>(u & 255), ty = static_cast<std::uint32_t>(v & 255);
    const auto pixel = [&](std::int64_t i, std::int64_t j) {
      return upright(static_cast<int>(std::clamp<std::int64_t>(i, 0, upright.width - 1)),
                     static_cast<int>(std::clamp<std::int64_t>(j, 0, upright.height - 1)));
    };
    const std::int64_t i = u >> 8, j = v >> 8;
    const Rgba8 a = pixel(i, j), b = pixel(i + 1, j), c = pixel(i, j + 1), d = pixel(i + 1, j + 1);
    const auto mix = [&](std::uint8_t Rgba8::*channel) {
      const std::uint32_t above = a.*channel * (256 - tx) + b.*channel * tx;
      const std::uint32_t below = c.*channel * (256 - tx) + d.*channel * tx;
      return static_cast<std::uint8_t>((above * (256 - ty) + below * ty + 32768) >> 16);
    };
    return {mix(&Rgba8::r), mix(&Rgba8::g), mix(&Rgba8::b), mix(&Rgba8::a)};
  }
  [[nodiscard]] RASTRUM_HD float operator()(const ImageView<const float>& upright, int x,
                                            int y) const {
    const Position at = position(upright.width, upright.height, x, y);
    // Rounding must not move a centre into the neighbouring pixel.
    const auto pixel = [](double p, int size) {
      return static_cast<int>(std::clamp(std::floor(p + 1e-6), 0.0, size - 1.0));
    };
    return upright(pixel(at.x, upright.width), pixel(at.y, upright.height));
  }

 private:
  double cos_, sin_;
  int width_, height_;
};

}  // namespace rastrum::terrain
