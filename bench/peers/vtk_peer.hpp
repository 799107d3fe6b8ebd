// SPDX-License-Identifier: BSD-3-Clause
// VTK's depth peeling (dual where the driver can, which llvmpipe does), which is how scientists
// draw translucent surfaces on CPUs today, its spheres, its points and its ambient occlusion:
// Debian's python3-vtk9 in a child process (vtk_peer.py), so that nothing is built against VTK.
#pragma once

#include <memory>
#include <span>
#include <string>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

class VtkPeer {
 public:
  /// Starts `$RASTRUM_VTK_PYTHON`, or /usr/bin/python3, and Xvfb where there is no display, with
  /// llvmpipe on `threads` rasterizing threads. Throws Error{no_device} saying what is missing.
  explicit VtkPeer(int threads = 2);
  ~VtkPeer();
  VtkPeer(const VtkPeer&) = delete;
  VtkPeer& operator=(const VtkPeer&) = delete;

  [[nodiscard]] std::string description() const;
  /// The mesh has indices, and normals that share them; else Error{invalid_argument}.
  void set_mesh(const MeshView& mesh);
  /// Spheres instead, by VTK's sphere mapper: a radius each.
  void set_spheres(std::span<const Vec3> centers, std::span<const float> radii);
  /// Points of one pixel instead, by VTK's point gaussian mapper without its splats.
  void set_points(std::span<const Vec3> positions);
  /// The camera is a perspective one; else Error{unsupported}.
  void set_view(const Camera& camera, int width, int height);

  /// From now on frames have screen-space ambient occlusion of this reach in the world, of 16
  /// samples and blurred; 0: none.
  void set_occlusion(double radius);

  /// Draws with the peers' `phong`, until no layer is left where the opacity is not 1; waits for
  /// the end.
  void draw(float opacity);
  /// The last frame's colours, premultiplied, of 8 bits.
  [[nodiscard]] Image<Vec4> picture();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
