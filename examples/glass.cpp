// SPDX-License-Identifier: BSD-3-Clause
// Opaque and translucent surfaces in one frame: a teapot inside three glass tubes that run through
// each other. The tubes' draw has kTranslucent, and the shader returns their alpha, which grows
// towards the silhouette. Nothing is sorted here.
#include <cmath>
#include <span>

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
  rastrum::Mesh mesh = rastrum::shapes::teapot();  // then the tubes, in the same arrays
  for (Vec3& p : mesh.positions) p = p * 0.42F + Vec3{0, -0.5F, 0};
  const std::size_t teapot_indices = mesh.indices.size();
  for (const int q : {3, 5, 7}) {
    const rastrum::Mesh tube = rastrum::shapes::torus_knot(2, q, 512, 32, 0.15F);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : tube.positions) mesh.positions.push_back(p * 1.2F);
    for (const Vec3 n : tube.normals.values) mesh.normals.values.push_back(n);
    for (const std::uint32_t i : tube.indices) mesh.indices.push_back(first + i);
  }

  rastrum::FrameOptions frame;  // transparency: exact
  frame.width = 480;
  frame.height = 360;
  frame.samples = 8;
  frame.background = {1, 1, 1, 1};
  rastrum::Camera camera;
  camera.eye = {0, 2.2F, 2.7F};
  camera.target = {0, -0.15F, 0};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    const Vec3 p = mesh.positions[i];
    return rastrum::VertexOutput<Surface>{transform_point(to_clip, p), {p, mesh.normals.values[i]}};
  };
  const auto shade = [&](const Surface& s, const rastrum::Fragment& f) {
    const float facing =
        std::abs(dot(normalize(s.normal), normalize(Vec3(camera.eye) - s.position)));
    const float light = 0.3F + 0.7F * facing;
    if (f.draw == 0) return Vec4{0.9F * light, 0.45F * light, 0.15F * light, 1};
    const float alpha = 0.1F + 0.7F * (1 - facing) * (1 - facing);
    return Vec4{0.2F, 0.5F, 0.6F, 1} * alpha;  // premultiplied
  };
  const rastrum::Program program(vertex, shade);
  const std::span<const std::uint32_t> indices = mesh.indices;
  rastrum::ProgramDraw draws[] = {
      program.draw(mesh.positions.size(), indices.first(teapot_indices)),
      program.draw(mesh.positions.size(), indices.subspan(teapot_indices))};
  draws[1].flags |= rastrum::kTranslucent;
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Renderer().draw(draws, frame, {.color8 = image});
  rastrum::io::write_png("glass.png", image);
}
