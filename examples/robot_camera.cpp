// A robot's camera: depth in metres, a mask of instances and points in the world, from OpenCV's K
// and a pose, as arrays and as pictures. Then a query for what lies under one pixel.
#include <cmath>
#include <cstdio>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

int main() {
  const rastrum::Mesh pot = rastrum::shapes::teapot(), ball = rastrum::shapes::sphere(),
                      knot = rastrum::shapes::torus_knot();
  const std::vector<rastrum::Vec3> table{{-0.6F, 0, -0.5F}, {-0.6F, 0, 0.4F}, {0.6F, 0, 0.4F},
                                         {-0.6F, 0, -0.5F}, {0.6F, 0, 0.4F},  {0.6F, 0, -0.5F}};
  const rastrum::MeshView views[] = {pot.view(), ball.view(), knot.view(), {.positions = table}};
  const auto at = [](double x, double y, double z, double size) {
    return rastrum::translation({x, y, z}) * rastrum::scaling({size, size, size});
  };
  std::vector<rastrum::InstanceView> instances{{views[0], at(-0.14, 0, 0.02, 0.075)},
                                               {views[1], at(0.22, 0.075, 0.12, 0.075)},
                                               {views[2], at(0.17, 0.13, -0.25, 0.08)},
                                               {views[3]}};
  for (int i = 0; i < 4; ++i) instances[static_cast<std::size_t>(i)].id = 7 + i;  // in the mask
  instances[0].color = rastrum::Vec4{0.85F, 0.55F, 0.35F, 1};
  instances[1].color = rastrum::Vec4{0.35F, 0.6F, 0.85F, 1};
  instances[2].color = rastrum::Vec4{0.5F, 0.75F, 0.4F, 1};
  const rastrum::SceneView scene{.instances = instances};

  rastrum::FrameOptions frame;
  frame.width = 640;
  frame.height = 480;
  frame.background = {0.9F, 0.93F, 0.96F, 1};
  // The camera stands 0.8 m away and 0.35 m high, and looks down by 20°, with OpenCV's y down and z
  // ahead.
  const double c = 0.9396926207859084, sine = 0.3420201433256687;
  const double rotation[9] = {1, 0, 0, 0, -c, sine, 0, -sine, -c};
  const rastrum::Vec3d eye{-0.05, 0.38, 0.8};
  const rastrum::Mat4d pose =
      rastrum::pose_from(rotation, {-eye.x, c * eye.y - sine * eye.z, sine * eye.y + c * eye.z});
  const rastrum::Camera camera = rastrum::camera_from_opencv(
      {.fx = 615, .fy = 615, .cx = 319.5, .cy = 239.5}, pose, frame.width, frame.height, 0.05);

  rastrum::Image<float> metres(frame.width, frame.height);
  rastrum::Image<std::int64_t> mask(frame.width, frame.height);
  rastrum::Image<rastrum::Vec3> points(frame.width, frame.height);
  rastrum::Image<rastrum::Rgba8> color(frame.width, frame.height);
  rastrum::Renderer renderer;
  renderer.render(scene, camera, frame,
                  {.color8 = color, .instances = mask, .positions = points, .view_depth = metres});
  rastrum::io::write_npy("robot_depth.npy", metres);
  rastrum::io::write_npy("robot_mask.npy", mask);
  rastrum::io::write_npy("robot_points.npy", points);
  rastrum::io::write_png("robot.png", color);

  // To look at: white at 0.5 m, black from 1.3 m on; a colour for each number of the mask.
  constexpr rastrum::Rgba8 kColors[] = {
      {230, 120, 60, 255}, {70, 150, 220, 255}, {110, 180, 90, 255}, {120, 120, 130, 255}};
  rastrum::Image<rastrum::Rgba8> greys(frame.width, frame.height), masks = greys;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const float near = std::fmin(std::fmax((1.3F - metres(x, y)) / 0.8F, 0.0F), 1.0F);
      const auto grey = static_cast<std::uint8_t>(255 * near);
      greys(x, y) = {grey, grey, grey, 255};
      if (mask(x, y) >= 0) masks(x, y) = kColors[mask(x, y) - 7];
    }
  rastrum::io::write_png("robot_depth.png", greys);
  rastrum::io::write_png("robot_masks.png", masks);

  if (const auto pick = renderer.pick(scene, camera, frame, 320, 300))
    std::printf("at (320, 300): instance %lld, triangle %llu, %.3f m away\n",
                static_cast<long long>(pick->instance_id),
                static_cast<unsigned long long>(pick->primitive), pick->view_depth);
}
