// Colours for heights that have none, and the light of a hillside.
#pragma once

#include <rastrum/core/image.hpp>
#include <rastrum/terrain/shadows.hpp>

namespace rastrum::terrain {

/// From lowland (t = 0) to snow (t = 1), clamped; NaN is 0. Hypsometric hues whose lightness rises
/// evenly (CIE L* from 30 to 97), so that equal steps of height look equal and a print in grey
/// still shows them.
[[nodiscard]] Rgba8 height_color(double t);

/// height_color of each height between the lowest and the highest; holes are black.
[[nodiscard]] Image<Rgba8> colors_by_height(ImageView<const float> heights);

/// What a slope shows of the sun's light: ambient + (1 − ambient) · max(0, cosine between the
/// normal and the sun). `dx`, `dy`: change of the height over a cell to the east and to the south.
[[nodiscard]] float hill_shade(float dx, float dy, const Sun& sun, float ambient);

/// hill_shade of each cell, by central differences within the tiled map; holes next to a cell count
/// as its own height.
[[nodiscard]] Image<float> hill_shading(ImageView<const float> heights, const Sun& sun,
                                        float ambient, Tiling tiling);

}  // namespace rastrum::terrain
