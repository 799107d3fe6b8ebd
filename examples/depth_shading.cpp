// SPDX-License-Identifier: BSD-3-Clause
// Shows depth³ as grey: near is white. The camera's far plane is right behind the model, so that
// its depths span [0, 1]. A second target gets the depth itself.
#include <array>
#include <cstdio>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

using rastrum::Vec4;

int main() {
  const rastrum::Mesh mesh = rastrum::shapes::gyroid(48, 2);

  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 360;
  rastrum::Camera camera;
  camera.orthographic = true;
  camera.orthographic_height = 3.1F;
  camera.eye = {2, 1.6F, 3};
  camera.near_plane = 2.1F;
  camera.far_plane = 5.6F;
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    return rastrum::VertexOutput<float>{transform_point(to_clip, mesh.positions[i]), 0};
  };
  const auto shade = [](float, const rastrum::Fragment& f) {
    const float grey = f.depth * f.depth * f.depth;
    return std::array{Vec4{grey, grey, grey, 1}, Vec4{f.depth, 0, 0, 1}};
  };
  const rastrum::Program program(vertex, shade);
  rastrum::ProgramDraw draw = program.draw(mesh.positions.size(), mesh.indices);

  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Image<Vec4> depth(frame.width, frame.height);
  const std::array extra{depth.view()};
  rastrum::Renderer().draw({&draw, 1}, frame, {.color8 = image, .extra = extra});
  rastrum::io::write_png("depth_shading.png", image);
  std::printf("depth_shading.png: the middle has depth %.4f\n", depth(240, 180).x);
}
