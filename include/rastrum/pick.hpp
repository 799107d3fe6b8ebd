// SPDX-License-Identifier: BSD-3-Clause
// The surface under a pixel: which instance and primitive, and where on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/scene.hpp>

namespace RASTRUM_API rastrum {

/// A primitive by its place in the scene.
struct Located {
  std::size_t instance = 0;     ///< index into SceneView::instances
  std::uint64_t primitive = 0;  ///< number within the instance
};

/// The primitive with number `id` (Targets::ids). O(instances). Throws Error{invalid_argument} if
/// the scene has fewer.
[[nodiscard]] Located locate(const SceneView& scene, std::uint64_t id);

/// The weights of the corners of a primitive, each in [0, 1]; they add up to 1.
struct Barycentrics {
  double weight[3] = {1, 0, 0};
};
/// The weights of the corners of primitive `id` at the centre of pixel (x, y) of a picture,
/// perspective-correct, in float64, of the snapped triangle that is drawn. The triangle need not be
/// seen there, but then its weights are cut to [0, 1]. For a cylinder, cone or tube they are the
/// weights of the two ends of its axis, on the side that faces the viewer, or on the other one if
/// that does not cover the pixel's centre; (1, 0, 0) if neither does. Primitives of one position
/// have (1, 0, 0), too. Throws Error{invalid_argument} as locate(), for a size that no picture has,
/// and for an index of its corners that is out of range.
[[nodiscard]] Barycentrics barycentrics(const SceneView& scene, const Camera& camera, int width,
                                        int height, std::uint64_t id, int x, int y);

/// The place in the world, in float64, that has the weights `where` in the primitive `at`. For
/// cylinders and tubes it lies on the axis, for spheres and discs it is the centre; Pick::position
/// lies on the surface. Throws Error{invalid_argument} if the scene has no primitive `at`, and for
/// an index of its corners that is out of range.
[[nodiscard]] Vec3d position(const SceneView& scene, const Located& at, const Barycentrics& where);

/// Whether a point of project() lies before the eye and in the picture with these
/// Targets::view_depth, and no surface hides it. It is hidden if all of the 3 × 3 pixels around it
/// show surfaces that are nearer by more than a part in 10⁴, and by more than the farthest of them
/// is farther than the fifth: surfaces do not hide the points that lie on them. Depths that are not
/// above 0 are nothing.
[[nodiscard]] bool is_seen(const ProjectedPoint& point, ImageView<const float> view_depth);

/// The outputs of a frame at one pixel; Targets describes each.
struct Pick {
  std::uint64_t id = 0;          ///< the primitive's number in order of submission
  std::size_t instance = 0;      ///< index into SceneView::instances
  std::int64_t instance_id = 0;  ///< InstanceView::id
  std::uint64_t primitive = 0;   ///< number within its instance
  Barycentrics barycentrics;
  Vec3d position;   ///< of the surface, in the world
  Vec3d normal;     ///< unit length, in the world, turned to the viewer; 0 where it has none
  float depth = 0;  ///< reversed
  double view_depth = 0, distance = 0;
  std::optional<double> scalar;  ///< of the geometry, interpolated; none: it has none
};

}  // namespace rastrum
