// SPDX-License-Identifier: BSD-3-Clause
// A program with its own vertex and fragment functions and its own varying: a waving flag with
// stripes, a hole that is discarded, and the normals as a second output.
#include <array>
#include <cmath>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>

using rastrum::Vec2, rastrum::Vec3, rastrum::Vec4;

/// Goes from the vertex function to the fragment function. Any type with + and * float will do.
struct Cloth {
  Vec2 at;
  Vec3 normal;
  Cloth operator+(const Cloth& o) const { return {at + o.at, normal + o.normal}; }
  Cloth operator*(float s) const { return {at * s, normal * s}; }
};

int main() {
  constexpr std::uint32_t kColumns = 64, kRows = 40;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i + kColumns < kColumns * kRows; ++i)
    if (i % kColumns != kColumns - 1)
      indices.insert(indices.end(),
                     {i, i + kColumns, i + 1, i + 1, i + kColumns, i + kColumns + 1});

  const rastrum::FrameOptions frame{.background = {0.93F, 0.95F, 0.98F, 1}};
  const rastrum::Camera camera{.eye = {0.3, 0.4, 2.2}};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, frame.width, frame.height));
  const auto vertex = [&](std::uint32_t i) {
    const Vec2 at{static_cast<float>(i % kColumns) / (kColumns - 1),
                  static_cast<float>(i / kColumns) / (kRows - 1)};
    const float phase = 9 * at.x + 2 * at.y;
    const Vec3 position{3 * at.x - 1.5F, 0.9F - 1.8F * at.y, 0.12F * std::sin(phase)};
    const Vec3 normal{-0.36F * std::cos(phase), 0.13F * std::cos(phase), 1};
    return rastrum::VertexOutput<Cloth>{transform_point(to_clip, position), {at, normal}};
  };
  const auto shade = [](const Cloth& c, const rastrum::Fragment&) {
    const Vec3 n = normalize(c.normal);
    const float light = 0.25F + 0.75F * dot(n, normalize(Vec3{0.4F, 0.6F, 1}));
    const bool red = static_cast<int>(c.at.y * 7) % 2 == 0;
    const Vec4 color = red ? Vec4{0.8F, 0.15F, 0.2F, 1} : Vec4{1, 1, 1, 1};
    return std::array{Vec4{color.x * light, color.y * light, color.z * light, 1},
                      Vec4{n.x, n.y, n.z, 1}};
  };
  const auto is_hole = [](const Cloth& c, const rastrum::Fragment&) {
    return std::hypot(c.at.x - 0.7F, c.at.y - 0.45F) < 0.06F;
  };
  const rastrum::Program program(vertex, shade, is_hole);
  const rastrum::ProgramDraw draw = program.draw(kColumns * kRows, indices);
  rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
  rastrum::Image<Vec4> normals(frame.width, frame.height);
  const std::array extra{normals.view()};
  rastrum::Renderer().draw({&draw, 1}, frame, {.color8 = image, .extra = extra});
  rastrum::io::write_png("custom_shader.png", image);
  rastrum::io::write_exr("custom_shader_normals.exr", normals);
}
