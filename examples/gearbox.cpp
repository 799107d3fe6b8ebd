// SPDX-License-Identifier: BSD-3-Clause
// A planetary gear as a translucent assembly, blended exactly. The lids of its housing have their
// own clip plane.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/transform.hpp>

using rastrum::Mat4d, rastrum::Mesh, rastrum::Vec3, rastrum::Vec3d, rastrum::Vec4;
constexpr double kTurn = 2 * std::numbers::pi;

/// Around the z axis, with `teeth` outside, or inside if there are fewer than 0.
Mesh ring(double inner, double outer, double from_z, double to_z, int teeth = 0) {
  constexpr std::uint32_t kSteps = 720;
  Mesh mesh;
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const double angle = kTurn * i / kSteps, c = std::cos(angle), s = std::sin(angle);
    const double tooth = 0.045 * std::clamp(2 * std::cos(teeth * angle), -1.0, 1.0);
    const double radii[] = {outer + (teeth > 0 ? tooth : 0), inner + (teeth < 0 ? tooth : 0)};
    for (const double r : radii)
      for (const double z : {from_z, to_z}) mesh.positions.push_back(Vec3(Vec3d{r * c, r * s, z}));
    const std::uint32_t a = 4 * i, b = 4 * ((i + 1) % kSteps);
    for (const auto& [p, q] : {std::pair{0U, 1U}, {3U, 2U}, {1U, 3U}, {2U, 0U}})  // four sides
      mesh.indices.insert(mesh.indices.end(), {a + p, b + p, b + q, a + p, b + q, a + q});
  }
  mesh.normals = rastrum::crease_normals(mesh.positions, mesh.indices, 35);
  return mesh;
}

int main() {
  rastrum::Scene scene;
  const auto add = [&](Mesh mesh, Vec4 color, const Mat4d& place = Mat4d::identity()) {
    const auto number = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({.mesh = number, .object_to_world = place, .color = color});
  };
  for (const double at : {0.0, kTurn / 3, 2 * kTurn / 3}) {
    const auto rolled = rastrum::rotation_about({0, 0, 1}, at * 15 / 7 + kTurn * 15 / 28);
    const Mat4d place = rastrum::translation({0.75 * std::cos(at), 0.75 * std::sin(at), 0});
    add(ring(0.1, 0.35, -0.22, 0.22, 14), {0.86F, 0.66F, 0.3F, 0.8F}, place * rotation(rolled));
    add(ring(0, 0.1, -0.5, 0.3), {0.4F, 0.43F, 0.48F, 1}, place);
  }
  add(ring(0.12, 0.4, -0.25, 0.25, 16), {0.8F, 0.3F, 0.24F, 1});
  add(ring(0, 0.12, -0.8, 1.8), {0.62F, 0.66F, 0.72F, 1});
  add(ring(1.1, 1.24, -0.25, 0.25, -44), {0.3F, 0.5F, 0.78F, 0.5F});
  for (const double z : {-0.75, 0.69}) {
    add(ring(0.16, 1.25, z, z + 0.06), {0.62F, 0.66F, 0.72F, 0.4F});
    scene.instances.back().clip_planes = {{{-0.75, -0.1, -0.65}, 0.1}};  // keeps what is farther
  }
  const rastrum::Camera camera{.eye = {2.7, 1.9, 3.3}, .fov_rad = 0.7F};
  const rastrum::FrameOptions frame{.width = 520, .height = 480, .samples = 8};
  const rastrum::SceneBinding binding(scene);
  rastrum::io::write_png("gearbox.png", render(binding.view(), camera, frame));
}
