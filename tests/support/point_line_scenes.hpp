// SPDX-License-Identifier: BSD-3-Clause
// Generated scenes of points, lines and triangles, for the library and for the brute-force oracle.
// Reproducible from a seed.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <rastrum/scene.hpp>

#include "tests/support/oracle.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {

struct PointLineScene {
  KeptInstances instances;
  Camera camera;
  int width = 0, height = 0;
  /// Snapped, with the scene's ids. Lines are cut by the library's clipper where needed.
  std::vector<SnappedPrimitive> primitives;
  std::uint64_t input = 0, dropped = 0;

  [[nodiscard]] SceneView view() const { return {instances, {}, {}}; }

  // Arrays of the views.
  std::deque<std::vector<Vec3>> positions;
  std::deque<std::vector<Vec3d>> wide_positions;
  std::deque<std::vector<Vec4>> colors;
  std::deque<std::vector<Vec3>> normals;
  std::deque<std::vector<float>> sizes;
  std::deque<std::vector<std::int64_t>> indices;
  std::deque<std::vector<std::uint16_t>> offsets;
};

/// At most 5 instances: round and square points of one and more pixels, with common or single
/// sizes; segments and polylines; triangles. Arrays have several types, with and without indices.
/// Some vertices are behind the eye, before the near plane, beyond the guard band, or NaN.
[[nodiscard]] PointLineScene generate_points_and_lines(std::uint64_t seed, int width, int height);

}  // namespace rastrum::test
