// SPDX-License-Identifier: BSD-3-Clause
// Places the default camera before an array of triangles of the program. It also finds the pixel of
// a point of the world, as for a label.
#include <cstdio>
#include <vector>

#include <rastrum/scene.hpp>

int main() {
  // A tetrahedron in the caller's own arrays, which Rastrum does not copy.
  const std::vector<rastrum::Vec3> positions{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  const std::vector<std::uint32_t> indices{0, 1, 3, 0, 2, 1, 0, 3, 2, 1, 2, 3};
  rastrum::MeshView mesh;
  mesh.positions = positions;
  mesh.indices = indices;
  const rastrum::InstanceView instance{mesh};
  rastrum::SceneView scene;
  scene.instances = {&instance, 1};

  const int width = 1280, height = 720;
  const float fov_rad = 1.04719755F;  // 60°
  const rastrum::Camera camera = rastrum::fit_camera(scene, fov_rad, false);
  std::printf("eye %g %g %g\n", camera.eye.x, camera.eye.y, camera.eye.z);

  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, width, height));
  for (const rastrum::Vec3 p : positions) {
    const rastrum::Vec4 clip = rastrum::transform_point(to_clip, p);
    const float x_px = (clip.x / clip.w + 1) * 0.5F * static_cast<float>(width);
    const float y_px = (1 - clip.y / clip.w) * 0.5F * static_cast<float>(height);
    std::printf("(%g, %g, %g) is drawn at pixel (%.1f, %.1f), depth %.6f\n", p.x, p.y, p.z, x_px,
                y_px, clip.z / clip.w);
  }
}
