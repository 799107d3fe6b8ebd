// SPDX-License-Identifier: BSD-3-Clause
// A molecule (C60) as exact spheres and cylinders. The atom under a pixel is red, its neighbours
// are orange.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

using rastrum::Vec3, rastrum::Vec4;

int main() {
  constexpr float kGolden = 1.618034F, kBond = 1.44F;  // Å
  std::vector<Vec3> atoms;
  for (const Vec3 p : {Vec3{0, 1, 3 * kGolden}, Vec3{1, 2 + kGolden, 2 * kGolden},
                       Vec3{kGolden, 2, 2 * kGolden + 1}})
    for (int signs = p.x == 0 ? 1 : 0; signs < 8; signs += p.x == 0 ? 2 : 1) {
      const float x = signs & 1 ? p.x : -p.x, y = signs & 2 ? p.y : -p.y;
      const float z = signs & 4 ? p.z : -p.z;
      for (const Vec3 atom : {Vec3{x, y, z}, Vec3{y, z, x}, Vec3{z, x, y}})
        atoms.push_back(atom * (kBond / 2));
    }
  std::vector<std::uint32_t> bonds;  // two atoms each
  for (std::uint32_t i = 0; i < atoms.size(); ++i)
    for (std::uint32_t j = 0; j < i; ++j)
      if (length(atoms[i] - atoms[j]) < 1.1F * kBond) bonds.insert(bonds.end(), {i, j});
  std::vector<Vec4> colors(atoms.size(), Vec4{0.35F, 0.37F, 0.4F, 1});

  const rastrum::SpheresView spheres{.centers = atoms, .radius = 0.45F, .colors = colors};
  const rastrum::CylindersView sticks{
      .positions = atoms, .indices = bonds, .radius = 0.16F, .colors = colors, .caps = false};
  const rastrum::InstanceView instances[] = {{spheres}, {sticks}};
  const rastrum::Material shiny{.metallic = 0, .roughness = 0.45F};
  const rastrum::SceneView scene{.instances = instances, .materials = {&shiny, 1}};

  const rastrum::FrameOptions frame{
      .width = 480, .height = 480, .background = {1, 1, 1, 1}, .samples = 8};
  const rastrum::Camera camera =
      rastrum::fit_picture(scene, {.eye = {0.5, 0.15, 1}}, frame.width, frame.height);
  rastrum::Renderer renderer;
  const auto pick = renderer.pick(scene, camera, frame, 212, 248);
  if (!pick || pick->instance != 0) return 1;  // nothing, or a bond
  for (std::size_t i = 0; i < bonds.size(); i += 2) {
    if (bonds[i] == pick->primitive) colors[bonds[i + 1]] = {0.95F, 0.6F, 0.15F, 1};
    if (bonds[i + 1] == pick->primitive) colors[bonds[i]] = {0.95F, 0.6F, 0.15F, 1};
  }
  colors[pick->primitive] = {0.8F, 0.1F, 0.1F, 1};
  std::printf("atom %llu of %zu, %.2f Å away\n", static_cast<unsigned long long>(pick->primitive),
              atoms.size(), pick->distance);

  rastrum::Image<rastrum::Rgba8> picture(frame.width, frame.height);
  renderer.render(scene, camera, frame, {.color8 = picture});
  rastrum::io::write_png("molecule.png", picture);
}
