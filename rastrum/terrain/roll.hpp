// Camera roll. The plane of the picture is upright and the view level, so a rolled picture is a
// rotated window of a larger upright one: exact for every angle, 360° of it. The larger picture is
// drawn, then sampled: colours bilinearly between pixel centres, depth at the nearest; at multiples
// of 90° both are the pixels themselves.
#pragma once

#include <rastrum/terrain/options.hpp>

namespace rastrum::terrain {

/// Options and camera of the upright picture that holds the rolled one about the same centre.
struct Upright {
  TerrainOptions options;
  TerrainCamera camera;
};
/// Throws Error{invalid_argument} where it would exceed the largest picture.
[[nodiscard]] Upright upright_of(const TerrainOptions& options, const TerrainCamera& camera);

/// Row y of `out`, which `roll_rad` turns counter-clockwise out of `upright`.
void roll_row(const ImageView<const Rgba8>& upright, double roll_rad, int y,
              const ImageView<Rgba8>& out) noexcept;
void roll_row(const ImageView<const float>& upright, double roll_rad, int y,
              const ImageView<float>& out) noexcept;

}  // namespace rastrum::terrain
