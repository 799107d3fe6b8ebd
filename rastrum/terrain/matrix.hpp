// The matrix under which points of the world fall on the pixels of the terrain's picture, so that
// meshes and sprites compose with it by depth.
#pragma once

#include <rastrum/core/mat.hpp>
#include <rastrum/terrain/options.hpp>

namespace rastrum::terrain {

/// Maps (x, height, y, 1), which is Rastrum's world with +y up and the map's rows along
/// +z, to clip space: x and y as everywhere (docs/conventions.md), depth z/w = near / distance,
/// reversed, with an infinite far plane. The horizon is a shear, the roll a rotation of the
/// picture. A point on a sample that is drawn falls into its column and on the upper edge of its
/// first row, the columns and rows of `classic` (W/2 across, 240 down) included. Throws
/// Error{invalid_argument} for the cylindrical projection, which is no matrix. Round it to float32
/// for draws; far from the map's corner give positions relative to the camera instead, and a camera
/// at 0, 0.
[[nodiscard]] Mat4d world_to_clip(const TerrainOptions& options, const TerrainCamera& camera,
                                  double near = 1);

/// The reversed depth of a distance under that matrix: 0 at +inf, the sky.
[[nodiscard]] inline float reversed_depth(float distance, double near = 1) {
  return static_cast<float>(near / static_cast<double>(distance));
}

}  // namespace rastrum::terrain
