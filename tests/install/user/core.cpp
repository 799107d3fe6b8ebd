// SPDX-License-Identifier: BSD-3-Clause
// A program that only renders.
#include <cstdio>
#include <vector>

#include <rastrum/render.hpp>

int main() {
  const std::vector<rastrum::Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  rastrum::MeshView mesh;
  mesh.positions = positions;
  const rastrum::InstanceView instance{mesh};
  rastrum::SceneView scene;
  scene.instances = {&instance, 1};
  const auto image =
      rastrum::render(scene, rastrum::fit_camera(scene, 1.0F, false), {.width = 64, .height = 64});
  int covered = 0;
  for (const rastrum::Rgba8 p : image.pixels()) covered += p.a != 0;
  std::printf("%d of %zu pixels\n", covered, image.pixels().size());
  return covered > 100 ? 0 : 1;
}
