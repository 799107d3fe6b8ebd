// SPDX-License-Identifier: BSD-3-Clause
// Spheres, tubes, a cone, an open cylinder and discs in one scene with a mesh: exact surfaces that
// cut each other and the floor.
#include <cmath>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

int main() {
  // A helix of balls on a tube.
  std::vector<rastrum::Vec3> helix;
  std::vector<float> thickness;
  std::vector<rastrum::Vec4> colors;
  for (int i = 0; i <= 200; ++i) {
    const float t = static_cast<float>(i) / 200;
    const float angle = 18 * t;
    helix.push_back({1.6F * std::cos(angle), 3.2F * t, 1.6F * std::sin(angle)});
    thickness.push_back(0.05F + 0.12F * t);
    colors.push_back({0.9F - 0.6F * t, 0.35F, 0.3F + 0.5F * t, 1});
  }
  rastrum::TubesView tube;
  tube.positions = helix;
  tube.radii = thickness;
  tube.colors = colors;

  const std::vector<rastrum::Vec3> centers{{-3.4F, 0.9F, 0}, {-2.7F, 0.4F, 1.1F}, {0, 1, 0}};
  const std::vector<float> radii{1.2F, 0.7F, 0.6F};
  rastrum::SpheresView spheres;
  spheres.centers = centers;
  spheres.radii = radii;

  const std::vector<rastrum::Vec3> ends{{3.2F, 0, 0}, {3.2F, 2.4F, 0}};
  const std::vector<float> cone_radii{1, 0};
  rastrum::CylindersView cone;
  cone.positions = ends;
  cone.radii = cone_radii;
  const std::vector<rastrum::Vec3> pipe_ends{{4.6F, 0.5F, 1}, {3.4F, 0.5F, 3}};
  rastrum::CylindersView pipe;
  pipe.positions = pipe_ends;
  pipe.radius = 0.45F;
  pipe.caps = false;

  const std::vector<rastrum::Vec3> places{{-1.7F, 0.01F, 2.4F}, {0.8F, 0.5F, 2.9F}};
  const std::vector<rastrum::Vec3> normals{{0, 1, 0}, {0.4F, 0.6F, 1}};
  rastrum::DiscsView discs;
  discs.centers = places;
  discs.normals = normals;
  discs.radius = 0.6F;

  const std::vector<rastrum::Vec3> corners{{-6, 0, -4}, {-6, 0, 5}, {6, 0, 5},
                                           {-6, 0, -4}, {6, 0, 5},  {6, 0, -4}};
  rastrum::MeshView floor;
  floor.positions = corners;

  const std::vector<rastrum::InstanceView> instances{{tube}, {spheres}, {cone},
                                                     {pipe}, {discs},   {floor}};
  rastrum::Camera camera;
  camera.eye = {1.5F, 4.2F, 9};
  camera.target = {0, 1, 0};
  camera.fov_rad = 0.75F;
  rastrum::FrameOptions options;
  options.width = 640;
  options.height = 360;
  options.samples = 8;
  options.background = {1, 1, 1, 1};
  rastrum::SceneView scene;
  scene.instances = instances;
  rastrum::io::write_png("surfaces.png", rastrum::render(scene, camera, options));
}
