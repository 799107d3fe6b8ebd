// SPDX-License-Identifier: BSD-3-Clause
// The camera: where it stands and what it sees. Its axes are right-handed: −z ahead and +y up.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

struct Camera {
  Vec3d eye{0, 0, 1};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  float fov_rad = 1.04719755F;  ///< 60°, across the smaller side of the image; in (0, π)
  bool orthographic = false;
  float orthographic_height = 2;  ///< world units across the smaller side of the image
  float near_plane = 0.01F;       ///< distance along the view axis; > 0 for perspective
  /// Where depth is 0, as beyond it. Finite if orthographic.
  float far_plane = std::numeric_limits<float>::infinity();
  /// World to clip space with reversed depth, for views that the members above cannot express (a
  /// terrain's horizon, which is a shear; lenses with a centre of their own). If it is set, the
  /// members above do not count.
  std::optional<Mat4d> matrix{};
};

// Cameras as other programs describe them; docs/cameras.md has the conventions in one table.

/// The lens as OpenCV's K = (fx s cx; 0 fy cy; 0 0 1), in px. A point (x, y, z) in the camera's
/// axes, x to the right, y down and z ahead, is seen at u = (fx x + s y) / z + cx, v = fy y / z +
/// cy. Distortion is not modelled: undistort the picture first.
struct Intrinsics {
  double fx = 0, fy = 0;  ///< not 0, and of one sign (else the picture is mirrored)
  double cx = 0, cy = 0;  ///< where the axis meets the picture; need not lie inside of it
  double skew = 0;
  /// u and v of the centre of the top left pixel: 0 in OpenCV, where a camera that looks through
  /// the middle has cx = (W − 1) / 2; 0.5 where it has cx = W / 2 (COLMAP, NeRF and its kin).
  double first_centre = 0;
};

/// The camera of a W × H picture with these intrinsics and a pose. `world_to_camera`: (R t; 0 1) in
/// OpenCV's axes, with R a rotation to 1e-6. Computed in float64; the far plane is infinite. A
/// picture of another size shows the same view, stretched.
/// Throws Error{invalid_argument} that names what is out of range.
[[nodiscard]] Camera camera_from_opencv(const Intrinsics& k, const Mat4d& world_to_camera,
                                        int width, int height, double near_plane = 0.01);
/// The pose (R t; 0 1) of a rotation, row after row, and a translation.
[[nodiscard]] Mat4d pose_from(const double (&rotation)[9], Vec3d translation);

/// The values of z / w in clip space at a projection's near and far plane.
enum class ClipDepth : std::uint8_t {
  opengl,       ///< −1 and 1
  zero_to_one,  ///< 0 and 1: Direct3D, Vulkan, Metal, WebGPU
  reversed      ///< 1 and 0: as in Rastrum
};

/// The camera of any 4 × 4 matrix from world to clip space, projection · view, with +y up. Throws
/// Error{invalid_argument} if it is singular or not finite.
[[nodiscard]] Camera camera_from_matrix(const Mat4d& world_to_clip, ClipDepth depth);

/// Makes `camera` orthographic and without a matrix, so that a pixel of a W × H picture is `units`
/// of the world wide. Throws Error{invalid_argument} unless units is > 0 and finite and the size at
/// least 1 × 1.
[[nodiscard]] Camera orthographic_by_scale(Camera camera, double units, int width, int height);

/// The matrix from world to clip space for a W × H image, with reversed depth (near 1, far 0), made
/// in float64. Throws Error{invalid_argument} that names the parameter which is out of range.
[[nodiscard]] Mat4d world_to_clip(const Camera& camera, int width, int height);

/// Throws Error{invalid_argument} unless 0 < fov_rad < π.
void check_fov(float fov_rad);

/// The rigid motion from world to camera space. A camera with a matrix gives what its rows say: the
/// view axis is perpendicular to the planes of equal w, y is as in the picture, and an orthographic
/// camera stands on its near plane. Throws Error{invalid_argument} if these give no three axes.
[[nodiscard]] Mat4d world_to_camera(const Camera& camera);

/// Where a picture shows a point of the world.
struct ProjectedPoint {
  /// px, the centre of the first pixel at (0.5, 0.5). NaN at and behind the eye of a perspective
  /// camera.
  double x = 0, y = 0;
  double view_depth = 0;  ///< as Targets::view_depth
};
/// Finds the points in a W × H picture, in float64; the picture may lie elsewhere than they do.
/// is_seen (pick.hpp) says whether something hides one. Throws as world_to_clip and
/// world_to_camera.
[[nodiscard]] std::vector<ProjectedPoint> project(const Camera& camera, int width, int height,
                                                  std::span<const Vec3d> points);

// From reversed depth back to world units.

/// The distance from the camera along its view axis, in world units, for the reversed depth d =
/// `depth` of a pixel (Targets::depth). With the camera's planes n and f it is n f / (d (f − n) +
/// n), n / d where f is infinite, and f − d (f − n) for an orthographic camera. It is infinite for
/// 0: nothing is there, or it lies at the far plane or beyond. Computed in float64. A camera with a
/// matrix uses its rows. Throws Error{invalid_argument} if depth does not determine the distance,
/// because planes of equal depth are not perpendicular to the axis.
[[nodiscard]] double view_distance(const Camera& camera, float depth);

}  // namespace rastrum
