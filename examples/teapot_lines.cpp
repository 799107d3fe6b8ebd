// SPDX-License-Identifier: BSD-3-Clause
// A teapot with its wireframe and its normals: triangles and lines of one program in one frame. The
// surface is moved back by a little more than its slope, so that its edges are visible.
#include <cstdio>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

using rastrum::Topology;
using rastrum::Vec3, rastrum::Vec4;

int main() {
  const rastrum::Mesh teapot = rastrum::shapes::teapot(6);
  const std::vector<std::uint32_t> edges = rastrum::edge_indices(teapot.view());
  std::vector<Vec3> positions = teapot.positions;
  std::vector<std::uint32_t> normals;
  for (const Vec3 p : rastrum::normal_lines(teapot.view(), 0.12F)) {
    normals.push_back(static_cast<std::uint32_t>(positions.size()));
    positions.push_back(p);
  }

  rastrum::Scene scene;
  scene.meshes.push_back(teapot);
  scene.instances.resize(1);
  rastrum::Camera camera = rastrum::fit_camera(rastrum::SceneBinding(scene).view(), 1.0F, false);
  camera.eye = Vec3(camera.eye) + Vec3{0.8F, 1.4F, -0.6F};
  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 360;
  frame.background = {1, 1, 1, 1};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    return rastrum::VertexOutput<float>{transform_point(to_clip, positions[i]), 0};
  };
  const auto shade = [](float, const rastrum::Fragment& f) {
    constexpr Vec4 kColors[] = {{0.86F, 0.88F, 0.9F, 1}, {0.1F, 0.2F, 0.4F, 1}, {0.8F, 0.3F, 0, 1}};
    return kColors[f.draw];
  };
  const rastrum::Program program(vertex, shade);
  rastrum::ProgramDraw draws[] = {program.draw(positions.size(), teapot.indices),
                                  program.draw(positions.size(), edges, Topology::lines),
                                  program.draw(positions.size(), normals, Topology::lines)};
  draws[0].depth_bias_slope = -1;
  draws[0].depth_bias = -1e-6F;
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Renderer().draw(draws, frame, {.color8 = image});
  rastrum::io::write_png("teapot_lines.png", image);
  std::puts("teapot_lines.png");
}
