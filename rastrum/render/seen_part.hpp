// The part of a scene's box that a picture sees, in slices of distance: where a light's pictures
// need to be fine.
#pragma once

#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// A place is kept where a · p + b ≥ 0.
struct HalfSpace {
  Vec3d a;
  double b = 0;
  [[nodiscard]] double operator()(const Vec3d& p) const { return dot(a, p) + b; }
};

/// Six half-spaces in pairs, and their corners: k has a bit for the second of each pair.
struct Hexahedron {
  HalfSpace sides[6];
  Vec3d corners[8];
};
[[nodiscard]] Hexahedron box_of(Vec3d low, Vec3d high);

/// The corners of what is in all of `parts`, and others of its faces.
[[nodiscard]] std::vector<Vec3d> common_corners(std::span<const Hexahedron> parts);

/// What a camera with a matrix sees from one distance to another, in the unit of its w.
[[nodiscard]] Hexahedron frustum(const Camera& camera, double first, double last);

/// What a W × H picture sees of the box, in slices of distance, near to far: one where the farthest
/// is less than 6 times as far as the nearest, or the projection is parallel, two up to 16 times,
/// else four. None where nothing is seen. `reach`: FrameOptions::shadow_distance.
[[nodiscard]] std::vector<Hexahedron> seen_slices(Vec3d low, Vec3d high, const Camera& camera,
                                                  int width, int height, double reach);

}  // namespace rastrum
