// SPDX-License-Identifier: BSD-3-Clause
// A mesh's edges as lines, each drawn once, brighter where they are near.
#include <algorithm>
#include <cstdio>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

using rastrum::Vec4;

int main() {
  const rastrum::Mesh knot = rastrum::shapes::torus_knot(2, 3, 160, 12);
  const std::vector<std::uint32_t> edges = rastrum::edge_indices(knot.view());

  rastrum::FrameOptions frame;
  frame.width = 360;
  frame.height = 270;
  frame.background = {0.97F, 0.97F, 0.95F, 1};
  rastrum::Camera camera;
  camera.eye = {0, 2.4F, 2.8F};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    const Vec4 clip = transform_point(to_clip, knot.positions[i]);
    return rastrum::VertexOutput<float>{clip, clip.w};  // the distance along the view
  };
  const auto shade = [](float distance, const rastrum::Fragment&) {
    const float fog = std::clamp((distance - 2.2F) / 3, 0.0F, 0.9F);
    return Vec4{0.05F + 0.85F * fog, 0.2F + 0.7F * fog, 0.35F + 0.55F * fog, 1};
  };
  const rastrum::Program program(vertex, shade);
  rastrum::ProgramDraw draw = program.draw(knot.positions.size(), edges, rastrum::Topology::lines);
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  const rastrum::FrameStats stats = rastrum::Renderer().draw({&draw, 1}, frame, {.color8 = image});
  rastrum::io::write_png("wireframe.png", image);
  std::printf("wireframe.png: %llu lines\n",
              static_cast<unsigned long long>(stats.triangles.input));
}
