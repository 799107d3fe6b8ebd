// SPDX-License-Identifier: BSD-3-Clause
// A cloud of points: a PLY file without faces, or hills that a scanner flew over. The hills have
// normals and are lit; the scanner's path is a line.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

namespace {

float height(float x, float z) {
  return 0.55F * std::sin(x) * std::cos(0.8F * z) + 0.1F * std::sin(2.7F * x + 1.9F * z);
}

/// Points are denser along the scanner's path, as in scans.
rastrum::Scene scan() {
  rastrum::Points points;
  std::mt19937 random(1);
  std::normal_distribution<float> across(0, 1.3F);
  std::uniform_real_distribution<float> along(-7, 7);
  for (int i = 0; i < 400'000; ++i) {
    const float x = along(random);
    const float off = across(random);
    if (std::abs(off) > 3) continue;
    const float z = 1.2F * std::sin(0.6F * x) + off;
    const float y = height(x, z);
    constexpr float e = 0.01F;
    points.positions.push_back({x, y, z});
    points.normals.push_back(
        {height(x - e, z) - height(x + e, z), 2 * e, height(x, z - e) - height(x, z + e)});
    const float t = (y + 0.65F) / 1.3F;  // from water to rock
    points.colors.push_back({0.25F + 0.75F * t, 0.55F + 0.3F * t, 0.75F - 0.35F * t, 1});
  }
  rastrum::Lines path;
  path.kind = rastrum::LineKind::polylines;
  for (float x = -7; x <= 7; x += 0.05F)
    path.positions.push_back({x, 1.6F, 1.2F * std::sin(0.6F * x)});
  path.colors.assign(path.positions.size(), {0.8F, 0.1F, 0.1F, 1});
  path.line_width = 2;

  rastrum::Scene scene;
  scene.geometries = {points, path};
  scene.instances.resize(2);
  for (std::uint32_t i = 0; i < 2; ++i) scene.instances[i].geometry = i;
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    rastrum::Scene scene = argc > 1 ? rastrum::io::read_scene(argv[1]) : scan();
    for (rastrum::Geometry& geometry : scene.geometries)
      if (auto* const points = std::get_if<rastrum::Points>(&geometry)) {
        points->point_size = 2.5F;
        points->round = true;
      }
    rastrum::FrameOptions frame;
    frame.width = 640;
    frame.height = 360;
    frame.shader = rastrum::Shader::lambert;
    frame.background = {1, 1, 1, 1};
    const rastrum::SceneBinding binding(scene);
    rastrum::Camera from_above;
    from_above.eye = {-0.4, 1.1, 1.4};
    from_above.target = {0, 0, 0};
    const rastrum::Camera camera =
        rastrum::fit_picture(binding.view(), from_above, frame.width, frame.height);
    rastrum::io::write_png("point_cloud.png", rastrum::render(binding.view(), camera, frame));
  } catch (const rastrum::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
