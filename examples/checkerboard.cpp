// SPDX-License-Identifier: BSD-3-Clause
// A Blinn-Phong teapot on a checkerboard that runs to the horizon: an infinite far plane, and a
// floor of two triangles whose squares are computed per pixel.
#include <algorithm>
#include <cmath>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

using rastrum::Vec3, rastrum::Vec4;

struct Surface {
  Vec3 position, normal;
  Surface operator+(const Surface& o) const { return {position + o.position, normal + o.normal}; }
  Surface operator*(float s) const { return {position * s, normal * s}; }
};

int main() {
  rastrum::Mesh mesh = rastrum::shapes::teapot(16);
  const auto floor = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3 corner : {Vec3{-900, 0, -900}, {-900, 0, 900}, {900, 0, 900}, {900, 0, -900}}) {
    mesh.positions.push_back(corner);
    mesh.normals.values.push_back({0, 1, 0});
  }
  for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(floor + i);

  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 360;
  frame.background = {0.62F, 0.75F, 0.9F, 1};
  rastrum::Camera camera;
  camera.eye = {2.5F, 3.2F, 6};
  camera.target = {0, 1, 0};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    const Vec3 p = mesh.positions[i];
    return rastrum::VertexOutput<Surface>{transform_point(to_clip, p), {p, mesh.normals.values[i]}};
  };
  const auto shade = [&](const Surface& s, const rastrum::Fragment& f) {
    const Vec3 v = normalize(Vec3(camera.eye) - s.position), l = normalize(Vec3{0.5F, 1, 0.6F});
    const Vec3 n = normalize(s.normal) * (dot(s.normal, v) < 0 ? -1.0F : 1.0F);
    const bool odd = std::fmod(std::floor(s.position.x) + std::floor(s.position.z), 2.0F) != 0;
    const bool pot = f.vertex[0] < floor;
    const Vec3 base = pot ? Vec3{0.75F, 0.3F, 0.2F} : Vec3{1, 1, 1} * (odd ? 0.2F : 0.9F);
    const float shine = pot ? std::pow(std::max(dot(n, normalize(l + v)), 0.0F), 60.0F) : 0;
    const Vec3 c =
        base * (0.15F + 0.85F * std::max(dot(n, l), 0.0F)) + Vec3{1, 1, 1} * (0.5F * shine);
    return Vec4{c.x, c.y, c.z, 1};
  };
  const rastrum::Program program(vertex, shade);
  rastrum::ProgramDraw draw = program.draw(mesh.positions.size(), mesh.indices);
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Renderer().draw({&draw, 1}, frame, {.color8 = image});
  rastrum::io::write_png("checkerboard.png", image);
}
