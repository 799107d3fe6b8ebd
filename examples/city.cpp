// SPDX-License-Identifier: BSD-3-Clause
// A city in UTM coordinates, millions of metres from their origin. Its float64 positions keep its
// edges straight. The second picture shows it rounded to float32, where neighbouring numbers are
// half a metre apart.
#include <cmath>
#include <cstdint>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

using rastrum::Vec3, rastrum::Vec3d, rastrum::Vec4;

constexpr Vec3d kOrigin{447000.25, 5411000.75, 33.5};  // easting, northing, height

struct City {
  std::vector<Vec3d> positions;
  std::vector<std::uint32_t> quads;
  std::vector<Vec4> colors;  // one per face

  void face(const Vec3d (&corners)[4], Vec4 color) {
    for (const Vec3d& p : corners) {
      quads.push_back(static_cast<std::uint32_t>(positions.size()));
      positions.push_back(kOrigin + p);
    }
    colors.push_back(color);
  }
  void box(Vec3d low, Vec3d high, Vec4 color) {
    const Vec4 roof{color.x * 0.8F, color.y * 0.78F, color.z * 0.76F, 1};
    const double x0 = low.x, x1 = high.x, y0 = low.y, y1 = high.y, z0 = low.z, z1 = high.z;
    face({{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}}, color);
    face({{x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}}, color);
    face({{x1, y1, z0}, {x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1}}, color);
    face({{x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}}, color);
    face({{x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}}, roof);
  }
  /// A core of glass behind floors and piers.
  void tower(double x, double y, double side, double height, Vec4 color) {
    constexpr Vec4 kGlass{0.4F, 0.53F, 0.64F, 1};
    const double x1 = x + side, y1 = y + side;
    box({x + 0.5, y + 0.5, 0}, {x1 - 0.5, y1 - 0.5, height}, kGlass);
    for (double z = 0; z < height; z += 3.6) box({x, y, z}, {x1, y1, z + 0.7}, color);
    for (int i = 0; i <= 6; ++i) {
      const double at = i * (side - 0.4) / 6;
      box({x + at, y - 0.2, 0}, {x + at + 0.4, y + 0.2, height}, color);
      box({x + at, y1 - 0.2, 0}, {x + at + 0.4, y1 + 0.2, height}, color);
      box({x - 0.2, y + at, 0}, {x + 0.2, y + at + 0.4, height}, color);
      box({x1 - 0.2, y + at, 0}, {x1 + 0.2, y + at + 0.4, height}, color);
    }
    box({x - 0.4, y - 0.4, height}, {x1 + 0.4, y1 + 0.4, height + 1.2}, color);
  }
};

City build() {
  City city;
  city.box({-3000, -3000, -1}, {3000, 3000, 0}, {0.55F, 0.56F, 0.54F, 1});
  std::uint32_t noise = 1;
  const auto next = [&] {
    noise = noise * 1664525 + 1013904223;
    return static_cast<double>(noise >> 8) / (1 << 24);
  };
  constexpr double kBlock = 42;
  for (int i = -14; i <= 5; ++i)
    for (int j = -14; j <= 5; ++j) {
      const double x = i * kBlock, y = j * kBlock;
      if (i == 2 || j == -1) continue;  // avenues
      city.box({x, y, 0}, {x + 34, y + 34, 0.25}, {0.66F, 0.66F, 0.63F, 1});
      if (next() < 0.1) {
        city.box({x + 1, y + 1, 0.25}, {x + 33, y + 33, 0.4}, {0.45F, 0.62F, 0.36F, 1});
        continue;
      }
      const double from_center = std::sqrt(double(i * i + j * j));
      const double most = 12 + 150 / (1 + from_center * from_center / 14);
      for (const double dx : {1.0, 18.0})
        for (const double dy : {1.0, 18.0}) {
          const auto shade = static_cast<float>(0.75 + 0.2 * next());
          const auto warm = static_cast<float>(0.1 * next());
          city.tower(x + dx, y + dy, 15, most * (0.3 + 0.7 * next()),
                     {shade, shade - warm / 2, shade - warm - 0.03F, 1});
        }
    }
  return city;
}

int main() {
  const City city = build();
  rastrum::MeshView mesh;
  mesh.positions = city.positions;
  mesh.indices = city.quads;
  mesh.faces = {rastrum::FaceKind::quads, {}};
  mesh.colors = {city.colors, {}, rastrum::Per::face};

  rastrum::Camera camera;
  camera.eye = kOrigin + Vec3d{196, 236, 66};
  camera.target = kOrigin + Vec3d{90, 60, 36};
  camera.up = {0, 0, 1};
  camera.fov_rad = 0.6F;
  camera.near_plane = 1;
  rastrum::FrameOptions frame;
  frame.width = 480;
  frame.height = 300;
  frame.samples = 8;
  frame.background = {0.78F, 0.87F, 0.95F, 1};
  frame.shader = rastrum::Shader::phong;
  const auto draw = [&](const char* file) {
    const rastrum::InstanceView instance{mesh};
    rastrum::io::write_png(file, rastrum::render({.instances = {&instance, 1}}, camera, frame));
  };
  draw("city.png");

  std::vector<Vec3> rounded;
  for (const Vec3d& p : city.positions) rounded.push_back(Vec3(p));
  mesh.positions = rounded;
  draw("city_float32.png");
}
