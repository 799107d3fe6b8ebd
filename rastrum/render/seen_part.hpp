// SPDX-License-Identifier: BSD-3-Clause
// The part of a scene's box that a picture sees, in slices of distance, which shadow maps cover.
#pragma once

#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// Keeps points with a · p + b ≥ 0.
struct HalfSpace {
  Vec3d a;
  double b = 0;
  [[nodiscard]] double operator()(const Vec3d& p) const { return dot(a, p) + b; }
};

/// Six half-spaces in opposite pairs, and their corners. Bit i of a corner's number chooses the
/// second of pair i.
struct Hexahedron {
  HalfSpace sides[6];
  Vec3d corners[8];
};
[[nodiscard]] Hexahedron box_of(Vec3d low, Vec3d high);

/// The corners of the intersection of `parts`, and maybe other points on its faces.
[[nodiscard]] std::vector<Vec3d> common_corners(std::span<const Hexahedron> parts);

/// The space that a camera with a matrix sees between two distances, in units of w.
[[nodiscard]] Hexahedron frustum(const Camera& camera, double first, double last);

/// The part of the box that a W × H picture sees, in slices of distance, near to far: one if the
/// projection is parallel or the far end is at most 6 times as far as the near end, two up to 16
/// times, else four; none if nothing is seen. `reach`: FrameOptions::shadow_distance.
[[nodiscard]] std::vector<Hexahedron> seen_slices(Vec3d low, Vec3d high, const Camera& camera,
                                                  int width, int height, double reach);

}  // namespace rastrum
