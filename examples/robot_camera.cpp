// SPDX-License-Identifier: BSD-3-Clause
// A robot's camera in a loop sees a pot and a ball on waves: depth in metres and a mask of
// instances, from OpenCV's K and a pose. Renderer, images and views stay; the arrays change.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

using rastrum::Vec3d, rastrum::Vec4;

int main() {
  constexpr int kNodes = 81, kWidth = 640, kHeight = 480;  // of the water along each side; pixels
  std::vector<Vec3d> water;
  std::vector<int> squares;  // four nodes each
  for (int i = 0; i < kNodes * kNodes; ++i) {
    water.push_back({0.02 * (i % kNodes) - 0.8, 0, 0.02 * (i / kNodes) - 1});
    if (i % kNodes != kNodes - 1 && i / kNodes != kNodes - 1)
      squares.insert(squares.end(), {i, i + kNodes, i + kNodes + 1, i + 1});
  }
  const rastrum::Mesh pot = rastrum::shapes::teapot(), ball = rastrum::shapes::sphere();
  const rastrum::MeshView views[] = {
      {.positions = water, .indices = squares, .faces = {rastrum::FaceKind::quads}},
      pot.view(),
      ball.view()};
  rastrum::InstanceView things[] = {
      {.geometry = views[0], .color = Vec4{0.55F, 0.7F, 0.75F, 1}, .id = 7},
      {.geometry = views[1], .color = Vec4{0.85F, 0.55F, 0.35F, 1}, .id = 8},
      {.geometry = views[2], .color = Vec4{0.5F, 0.75F, 0.4F, 1}, .id = 9}};
  // 0.8 m away and 0.38 m high, looking down by 20°; OpenCV has y down and z ahead.
  const double c = std::cos(0.349), s = std::sin(0.349);
  const rastrum::Mat4d pose = rastrum::pose_from({1, 0, 0, 0, -c, s, 0, -s, -c},
                                                 {0, 0.38 * c - 0.8 * s, 0.38 * s + 0.8 * c});
  const rastrum::Camera camera = rastrum::camera_from_opencv(
      {.fx = 615, .fy = 615, .cx = 319.5, .cy = 239.5}, pose, kWidth, kHeight);
  const rastrum::FrameOptions frame{.width = kWidth, .height = kHeight, .no_distance = 0};
  const rastrum::Mat4d size = rastrum::scaling({0.075, 0.075, 0.075});
  rastrum::Renderer renderer;
  rastrum::Image<rastrum::Rgba8> color(kWidth, kHeight);
  rastrum::Image<float> metres(kWidth, kHeight);
  rastrum::Image<std::int32_t> mask(kWidth, kHeight);
  for (int step = 0; step < 10; ++step) {
    for (Vec3d& p : water)
      p.y = 0.012 * std::sin(14 * p.x + 0.5 * step) + 0.008 * std::sin(19 * p.z - 0.4 * step);
    things[1].object_to_world = rastrum::translation(water[50 * kNodes + 33]) * size;
    things[2].object_to_world = rastrum::translation(water[55 * kNodes + 50]) * size;
    renderer.render({.instances = things}, camera, frame,
                    {.color8 = color, .instances32 = mask, .view_depth = metres});
    std::printf("%d: %.3f m in the middle, %td pixels of the ball\n", step,
                double{metres(320, 240)}, std::ranges::count(mask.pixels(), 9));
  }
  rastrum::io::write_npy("robot_depth.npy", metres);
  rastrum::io::write_npy("robot_mask.npy", mask);
  rastrum::io::write_png("robot.png", color);
}
