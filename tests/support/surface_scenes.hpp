// SPDX-License-Identifier: BSD-3-Clause
// Generated scenes of spheres, cylinders, cones, tubes, discs and triangles, for the library and
// the surface oracle. Reproducible from a seed.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <rastrum/scene.hpp>

#include "tests/support/scenes.hpp"
#include "tests/support/surface_oracle.hpp"

namespace rastrum::test {

struct SurfaceScene {
  std::string kind;
  KeptInstances instances;
  std::vector<Material> materials;  ///< empty, or one
  Camera camera;
  int width = 0, height = 0;
  std::vector<SurfacePrimitive> primitives;
  OracleCamera eye;
  std::size_t dropped = 0;             ///< primitives that a renderer drops and counts
  std::vector<ClipPlane> clip_planes;  ///< of the world

  [[nodiscard]] SceneView view() const { return {instances, materials, {}}; }

  // Arrays of the views.
  std::deque<std::vector<Vec3>> positions;
  std::deque<std::vector<float>> radii;
  std::deque<std::vector<std::uint32_t>> indices;
  std::deque<std::vector<ClipPlane>> own_planes;
};

/// The number of kinds; `generate_surfaces` makes kind seed % kSurfaceKinds.
extern const int kSurfaceKinds;

/// At most 12 primitives.
[[nodiscard]] SurfaceScene generate_surfaces(std::uint64_t seed, int width, int height);

/// Adds up to two world planes to the scene, and one or two of its own to every second instance,
/// for the library and the oracle.
void add_clip_planes(SurfaceScene& scene, std::uint64_t seed);

}  // namespace rastrum::test
