// SPDX-License-Identifier: BSD-3-Clause
// The surface under a pixel: which instance and primitive, and where on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <rastrum/camera.hpp>
#include <rastrum/scene.hpp>

namespace RASTRUM_API rastrum {

/// A primitive by its place in the scene.
struct Located {
  std::size_t instance = 0;     ///< place in SceneView::instances
  std::uint64_t primitive = 0;  ///< within it
};

/// The primitive that has number `id` (Targets::ids). O(instances). Throws Error{invalid_argument}
/// where the scene has fewer.
[[nodiscard]] Located locate(const SceneView& scene, std::uint64_t id);

/// Shares of the corners of a primitive, each in [0, 1], adding up to 1.
struct Barycentrics {
  double weight[3] = {1, 0, 0};
};
/// How much of each corner of primitive `id` there is at the centre of pixel (x, y) of a W × H
/// picture: perspective-correct, of the snapped triangle that is drawn. The triangle need not be
/// seen there, but its weights are then cut. In float64. For a cylinder, cone or tube: the shares
/// of the two ends of its axis, on the side that faces the viewer, or on the other one where that
/// does not cover the pixel's centre; (1, 0, 0) where neither does, and for primitives of one
/// position. Throws Error{invalid_argument} as locate(), for a picture that no frame has, and for
/// an index of its corners that is out of range.
[[nodiscard]] Barycentrics barycentrics(const SceneView& scene, const Camera& camera, int width,
                                        int height, std::uint64_t id, int x, int y);

/// Where these lie in the world, in float64: of spheres, cylinders, tubes and discs on the axis, or
/// at the centre (of the surface: Pick::position). Throws Error{invalid_argument} where `at` is
/// none of the scene's, and for an index of its corners that is out of range.
[[nodiscard]] Vec3d position(const SceneView& scene, const Located& at, const Barycentrics& where);

/// The outputs of a frame at one pixel; Targets describes each.
struct Pick {
  std::uint64_t id = 0;          ///< of the primitive in order of submission
  std::size_t instance = 0;      ///< its place in SceneView::instances
  std::int64_t instance_id = 0;  ///< InstanceView::id
  std::uint64_t primitive = 0;   ///< within its instance
  Barycentrics barycentrics;
  Vec3d position;   ///< of the surface, in the world
  Vec3d normal;     ///< unit length, in the world, turned to the viewer; 0 where it has none
  float depth = 0;  ///< reversed
  double view_depth = 0, distance = 0;
  std::optional<double> scalar;  ///< the geometry's, interpolated; none: it has none
};

}  // namespace rastrum
