// The camera: where it stands and what it sees. Right-handed, looks along its own −z, +y up.
#pragma once

#include <limits>
#include <optional>

#include <rastrum/mat.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

struct Camera {
  Vec3d eye{0, 0, 1};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  float fov_rad = 1.04719755F;  ///< 60°, across the smaller side of the image
  bool orthographic = false;
  float orthographic_height = 2;  ///< world units across the smaller side of the image
  float near_plane = 0.01F;       ///< > 0 for perspective
  float far_plane = std::numeric_limits<float>::infinity();  ///< depth 0; beyond it depth stays 0
  /// World to clip, for what no lens of this kind sees (a terrain's horizon is a shear); depth
  /// reversed. Nothing else counts then.
  std::optional<Mat4d> matrix{};
};

/// World to clip for a W × H image, reversed depth (near 1, far 0). Composed in float64.
/// Throws Error{invalid_argument} that names the parameter which is out of range.
[[nodiscard]] Mat4d world_to_clip(const Camera& camera, int width, int height);

/// Throws Error{invalid_argument} unless 0 < fov_rad < π.
void check_fov(float fov_rad);

/// World to camera space, a rigid motion.
[[nodiscard]] Mat4d world_to_camera(const Camera& camera);

// From reversed depth back to world units.

/// How far from the camera, along its view axis and in world units, a pixel of reversed depth
/// `depth` lies (Targets::depth), by the camera's planes n and f: n f / (d (f − n) + n), n / d
/// where f is infinite, f − d (f − n) for an orthographic camera. Infinity for 0: nothing is there,
/// or it lies at the far plane or beyond. In float64. Requires a camera without a matrix of its
/// own.
[[nodiscard]] double view_distance(const Camera& camera, float depth);

}  // namespace rastrum
