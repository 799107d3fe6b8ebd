// SPDX-License-Identifier: BSD-3-Clause
// A terrain's camera as a Camera, for meshes and lights.
#pragma once

#include <algorithm>
#include <span>

#include <rastrum/camera.hpp>
#include <rastrum/core/elementary.hpp>
#include <rastrum/light.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum {

/// Its place and axes in the terrain's world, without its lens. It looks level: a horizon off the
/// middle is a shear of the picture.
[[nodiscard]] inline Camera terrain_camera(const terrain::TerrainCamera& of) {
  const auto [sin, cos] = elementary::sin_cos(of.angle_rad);
  const auto [roll_sin, roll_cos] = elementary::sin_cos(of.roll_rad);
  Camera camera;
  camera.eye = {of.x, of.altitude, of.y};
  camera.target = camera.eye + Vec3d{-sin, 0, -cos};
  camera.up = {roll_sin * cos, roll_cos, -roll_sin * sin};
  return camera;
}

/// From the terrain's world to clip space.
[[nodiscard]] inline Camera terrain_lens(const terrain::TerrainOptions& options,
                                         const terrain::TerrainCamera& of) {
  Camera camera;
  camera.matrix = terrain::world_to_clip(options, of, SceneOnTerrain::kNear);
  return camera;
}

[[nodiscard]] inline bool is_of_camera(std::span<const Light> lights) {
  return std::ranges::any_of(lights, &Light::of_camera);
}

}  // namespace rastrum
