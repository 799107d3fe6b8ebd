// SPDX-License-Identifier: BSD-3-Clause
// Points of two sizes: a Fibonacci sphere in squares, and its equator in larger points that a
// discard function makes round.
#include <cmath>
#include <cstdio>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>

using rastrum::ProgramDraw, rastrum::Fragment, rastrum::Topology;
using rastrum::Vec3, rastrum::Vec4;

int main() {
  constexpr std::uint32_t kSphere = 3000, kRing = 60;
  std::vector<Vec3> positions;
  for (std::uint32_t i = 0; i < kSphere; ++i) {
    const float y = 1 - (static_cast<float>(i) + 0.5F) * (2.0F / kSphere);
    const float angle = 2.3999632F * static_cast<float>(i);  // the golden angle
    const float r = std::sqrt(1 - y * y);
    positions.push_back({r * std::cos(angle), y, r * std::sin(angle)});
  }
  std::vector<std::uint32_t> ring;
  for (std::uint32_t i = 0; i < kRing; ++i) {
    const float angle = 6.2831853F / kRing * static_cast<float>(i);
    ring.push_back(static_cast<std::uint32_t>(positions.size()));
    positions.push_back({1.3F * std::cos(angle), 0, 1.3F * std::sin(angle)});
  }

  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 360;
  frame.background = {0.06F, 0.07F, 0.1F, 1};
  rastrum::Camera camera;
  camera.eye = {0, 1.2F, 2.6F};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    return rastrum::VertexOutput<Vec3>{transform_point(to_clip, positions[i]), positions[i]};
  };
  const auto shade = [](Vec3 p, const Fragment& f) {
    const float near = 0.35F + 0.25F * (p.z + 1.3F);
    return f.draw == 0 ? Vec4{0.4F * near, 0.7F * near, near, 1} : Vec4{near, 0.6F * near, 0.1F, 1};
  };
  const auto is_corner = [](Vec3, const Fragment& f) {
    return f.draw == 1 && std::hypot(f.point.x - 0.5F, f.point.y - 0.5F) > 0.5F;
  };
  const rastrum::Program program(vertex, shade, is_corner);
  ProgramDraw draws[] = {program.draw(kSphere, {}, Topology::points),
                         program.draw(positions.size(), ring, Topology::points)};
  draws[0].point_size = 3;
  draws[1].point_size = 11;
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Renderer().draw(draws, frame, {.color8 = image});
  rastrum::io::write_png("points.png", image);
  std::puts("points.png");
}
