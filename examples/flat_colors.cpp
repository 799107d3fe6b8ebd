// SPDX-License-Identifier: BSD-3-Clause
// A random colour for each triangle, from its id alone: the shader needs no attribute. The model is
// turned by a quaternion half way between two poses.
#include <cstdio>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

using rastrum::Vec4;

int main() {
  const rastrum::Mesh mesh = rastrum::shapes::sphere(14, 28);

  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 360;
  frame.cull = rastrum::Cull::back;
  rastrum::Camera camera;
  camera.eye = {0, 0, 2.5F};
  const rastrum::Quaternion upright, tilted = rastrum::rotation_about({1, 0, 1}, 1.6);
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height) *
                              rastrum::rotation(rastrum::slerp(upright, tilted, 0.5)));
  const auto vertex = [&](std::uint32_t i) {
    return rastrum::VertexOutput<float>{transform_point(to_clip, mesh.positions[i]), 0};
  };
  const auto shade = [](float, const rastrum::Fragment& f) {
    auto hash = static_cast<std::uint32_t>(f.id) * 0x9e3779b9U + 0x7f4a7c15U;
    hash = (hash ^ hash >> 16) * 0x85ebca6bU;
    hash ^= hash >> 13;
    const auto channel = [hash](int shift) {
      return 0.25F + 0.75F / 255 * static_cast<float>(hash >> shift & 255U);
    };
    return Vec4{channel(0), channel(8), channel(16), 1};
  };
  const rastrum::Program program(vertex, shade);
  rastrum::ProgramDraw draw = program.draw(mesh.positions.size(), mesh.indices);
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Renderer().draw({&draw, 1}, frame, {.color8 = image});
  rastrum::io::write_png("flat_colors.png", image);
  std::puts("flat_colors.png");
}
