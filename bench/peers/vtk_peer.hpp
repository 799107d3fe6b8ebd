// SPDX-License-Identifier: BSD-3-Clause
// VTK's depth peeling (dual where the driver can, as llvmpipe can), which scientists use today to
// draw translucent surfaces on CPUs; also its spheres, points and ambient occlusion. Debian's
// python3-vtk9 runs in a child process (vtk_peer.py), so that nothing is built against VTK.
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
  /// Starts `$RASTRUM_VTK_PYTHON` or /usr/bin/python3, and Xvfb if there is no display, with
  /// llvmpipe on `threads` rasterizing threads. Throws Error{no_device}, which says what is
  /// missing.
  explicit VtkPeer(int threads = 2);
  ~VtkPeer();
  VtkPeer(const VtkPeer&) = delete;
  VtkPeer& operator=(const VtkPeer&) = delete;

  [[nodiscard]] std::string description() const;
  /// Throws Error{invalid_argument} unless the mesh has indices, and normals that share them.
  void set_mesh(const MeshView& mesh);
  /// Takes spheres instead, by VTK's sphere mapper: a radius each.
  void set_spheres(std::span<const Vec3> centers, std::span<const float> radii);
  /// Takes points of one pixel instead, by VTK's point gaussian mapper without splats.
  void set_points(std::span<const Vec3> positions);
  /// Throws Error{unsupported} unless the camera is a perspective one.
  void set_view(const Camera& camera, int width, int height);

  /// Gives later frames screen-space ambient occlusion of this world radius, with 16 samples and
  /// blur; 0: none.
  void set_occlusion(double radius);

  /// Draws with the peers' `phong` and waits for the end. Below opacity 1 it peels all layers.
  void draw(float opacity);
  /// The last frame's colours, premultiplied, 8 bits.
  [[nodiscard]] Image<Vec4> picture();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
