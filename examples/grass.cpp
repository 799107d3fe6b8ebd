// SPDX-License-Identifier: BSD-3-Clause
// Several meshes and several passes: a hill, a teapot, a ball and blades of grass. A later pass
// loads the earlier visibility keys, so that the nearer wins.
#include <algorithm>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

using rastrum::ProgramDraw, rastrum::Fragment, rastrum::VertexOutput;
using rastrum::Vec3, rastrum::Vec4;

int main() {
  rastrum::FrameOptions frame;
  frame.width = 240;
  frame.height = 180;
  frame.background = {0.6F, 0.78F, 0.95F, 1};
  rastrum::Camera camera;
  camera.eye = {0, 2, 6};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  rastrum::Renderer renderer;
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Image<std::uint64_t> keys(frame.width, frame.height);
  const rastrum::Targets targets{.color8 = image, .keys = keys};
  rastrum::Pass pass;
  const auto draw_pass = [&](const ProgramDraw& draw) {
    renderer.draw({&draw, 1}, frame, targets, pass);
    pass.load = true;
    pass.first_id += draw.primitive_count;
  };
  const auto mesh_pass = [&](const rastrum::Mesh& mesh, Vec3 place, float scale, Vec3 base) {
    const auto vertex = [&](std::uint32_t i) {
      const Vec4 clip = transform_point(to_clip, mesh.positions[i] * scale + place);
      return VertexOutput<Vec3>{clip, mesh.normals.values[i]};
    };
    const rastrum::Program program(vertex, [&](Vec3 n, const Fragment&) {
      const float cosine = dot(normalize(n), Vec3{0.32F, 0.81F, 0.49F});
      const Vec3 c = base * (0.25F + 0.75F * std::max(cosine, 0.0F));
      return Vec4{c.x, c.y, c.z, 1};
    });
    draw_pass(program.draw(mesh.positions.size(), mesh.indices));
  };
  mesh_pass(rastrum::shapes::sphere(64), {0, -300, 0}, 300, {0.15F, 0.35F, 0.08F});
  mesh_pass(rastrum::shapes::teapot(), {-1, 0, 0.4F}, 0.6F, {0.9F, 0.5F, 0.2F});
  mesh_pass(rastrum::shapes::sphere(), {1.7F, 0.7F, -0.5F}, 0.9F, {0.5F, 0.5F, 0.9F});
  const auto blade = [&](std::uint32_t i) {  // left, right, tip
    const auto random = [&](std::uint32_t salt) {
      const std::uint32_t h = (i / 3 * 8 + salt) * 0x9e3779b9U, g = (h ^ h >> 15) * 0x85ebca6bU;
      return static_cast<float>((g ^ g >> 13) & 0xffffU) / 65536;
    };
    const bool tip = i % 3 == 2;
    const float side = tip ? 0.3F * random(2) - 0.15F : i % 3 == 0 ? -0.012F : 0.012F;
    const Vec3 p{14 * random(0) - 7 + side, tip ? 0.1F + 0.3F * random(3) : 0, 12 * random(1) - 7};
    return VertexOutput<float>{transform_point(to_clip, p), tip ? 0.6F + 0.3F * random(4) : 0.25F};
  };
  const rastrum::Program grass(blade, [](float g, const Fragment&) {
    return Vec4{0.5F * g, g, 0.15F * g, 1};
  });
  draw_pass(grass.draw(std::size_t{3} * 30000));
  rastrum::io::write_png("grass.png", image);
}
