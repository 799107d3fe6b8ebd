// SPDX-License-Identifier: BSD-3-Clause
// Embree's primary rays, the peer that traces rays: one through each pixel centre, shaded with the
// same `phong`. Packets have 16 rays (4 × 4 pixels) if the machine traces those natively, else 8 (4
// × 2).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

class EmbreePeer {
 public:
  /// Throws Error{no_device} with Embree's reason.
  explicit EmbreePeer(int threads = 2);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  [[nodiscard]] std::string description() const;

  /// Copies the mesh into buffers with Embree's padding. Throws Error{invalid_argument} unless the
  /// normals share the positions' indices.
  void set_mesh(const MeshView& mesh);
  /// Takes spheres instead (RTC_GEOMETRY_TYPE_SPHERE_POINT), a radius each; copies them.
  void set_spheres(std::span<const Vec3> centers, std::span<const float> radii);
  /// Takes tubes instead (RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE), a radius per position; copies
  /// them. Polyline i has positions [offsets[i], offsets[i + 1]).
  void set_tubes(std::span<const Vec3> positions, std::span<const float> radii,
                 std::span<const std::uint32_t> offsets);
  /// Rebuilds the acceleration structure at Embree's default quality.
  void build();
  /// Traces and shades into `image`; transparent black where a ray hits nothing. Throws
  /// Error{invalid_argument} before the first `build`.
  void trace(const Camera& camera, ImageView<Rgba8> image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
