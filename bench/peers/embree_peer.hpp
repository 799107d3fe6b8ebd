// SPDX-License-Identifier: BSD-3-Clause
// Embree primary rays: the peer from the other family. One ray through each pixel centre, in
// packets of 16 (4 × 4 pixels) where the machine traces those natively, else 8 (4 × 2), shaded with
// the same `phong`.
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

  /// Copies the mesh into buffers with the padding that Embree asks for. Needs normals that share
  /// the positions' indices; throws Error{invalid_argument} otherwise.
  void set_mesh(const MeshView& mesh);
  /// Spheres instead (RTC_GEOMETRY_TYPE_SPHERE_POINT); copies them. A radius each.
  void set_spheres(std::span<const Vec3> centers, std::span<const float> radii);
  /// Tubes instead (RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE); copies them. A radius a position;
  /// polyline i has positions [offsets[i], offsets[i + 1]).
  void set_tubes(std::span<const Vec3> positions, std::span<const float> radii,
                 std::span<const std::uint32_t> offsets);
  /// Builds the acceleration structure anew, at Embree's default quality.
  void build();
  /// Traces and shades into `image`; transparent black where a ray meets nothing.
  /// Throws Error{invalid_argument} before the first `build`.
  void trace(const Camera& camera, ImageView<Rgba8> image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
