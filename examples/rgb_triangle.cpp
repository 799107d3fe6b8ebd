// SPDX-License-Identifier: BSD-3-Clause
// The first example of paper 1: one triangle whose corners are red, green and blue. A varying may
// be any type with + and * float; here it is a Vec3.
#include <cstdio>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>

using rastrum::Vec3, rastrum::Vec4;

int main() {
  const auto vertex = [](std::uint32_t i) {
    constexpr Vec4 kCorner[] = {{-0.8F, -0.7F, 0, 1}, {0.8F, -0.7F, 0, 1}, {0, 0.8F, 0, 1}};
    constexpr Vec3 kColor[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return rastrum::VertexOutput<Vec3>{kCorner[i], kColor[i]};
  };
  const auto shade = [](Vec3 color, const rastrum::Fragment&) {
    return Vec4{color.x, color.y, color.z, 1};
  };
  const rastrum::Program program(vertex, shade);
  rastrum::ProgramDraw draw = program.draw(3);

  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 360;
  frame.background = {0.1F, 0.1F, 0.12F, 1};
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Renderer().draw({&draw, 1}, frame, {.color8 = image});
  rastrum::io::write_png("rgb_triangle.png", image);
  std::puts("rgb_triangle.png");
}
