// SPDX-License-Identifier: BSD-3-Clause
// Pictures of how a picture was drawn: fragments per pixel, and wrong orders that --show-errors
// found.
#pragma once

#include <array>
#include <cstdint>

#include <rastrum/image.hpp>

namespace rastrum::cli {

struct Heatmap {
  Image<Rgba8> image;
  std::uint32_t max = 0;  ///< at the fullest pixel
  std::uint64_t sum = 0;  ///< over all pixels: FrameStats::fragments
};

/// Black without a fragment; else the ramp at log(n) / log(max), so that one layer and two differ
/// visibly beside two hundred.
[[nodiscard]] Heatmap make_heatmap(ImageView<const std::uint32_t> overdraw);

inline constexpr int kRampSize = 1024;
/// Dark violet through red to light yellow; equal steps look equally far apart.
[[nodiscard]] const std::array<Rgba8, kRampSize>& heat_ramp();
/// The place of n > 0 fragments on the ramp.
[[nodiscard]] int ramp_index(std::uint32_t n, std::uint32_t max);

struct ErrorPicture {
  Image<Rgba8> image;
  std::uint64_t wrong = 0;  ///< pixels
};

/// Red where `errors` is not 0, else the picture over black as a dim grey.
[[nodiscard]] ErrorPicture make_error_picture(ImageView<const Rgba8> color8,
                                              ImageView<const std::uint8_t> errors);

}  // namespace rastrum::cli
