// What a robot's camera sees: depth in metres, a mask of instances and points in the world, from
// OpenCV's K and a pose. Then what lies under one pixel.
#include <cstdio>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

int main() {
  const rastrum::Mesh pot = rastrum::shapes::teapot(), ball = rastrum::shapes::sphere();
  std::vector<rastrum::InstanceView> instances{
      {pot.view(), rastrum::scaling({0.05, 0.05, 0.05})},
      {ball.view(), rastrum::translation({0.25, 0.05, 0}) * rastrum::scaling({0.05, 0.05, 0.05})}};
  instances[0].id = 7;  // what the mask says of it
  const rastrum::SceneView scene{.instances = instances};

  rastrum::FrameOptions frame;
  frame.width = 640;
  frame.height = 480;
  // The camera looks along the world's −z from 0.8 m, with OpenCV's y down and z ahead.
  const double rotation[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1};
  const rastrum::Mat4d pose = rastrum::pose_from(rotation, {-0.1, 0.1, 0.8});
  const rastrum::Camera camera = rastrum::camera_from_opencv(
      {.fx = 615, .fy = 615, .cx = 319.5, .cy = 239.5}, pose, frame.width, frame.height, 0.05);

  rastrum::Image<float> metres(frame.width, frame.height);
  rastrum::Image<std::int64_t> mask(frame.width, frame.height);
  rastrum::Image<rastrum::Vec3> points(frame.width, frame.height);
  rastrum::Renderer renderer;
  renderer.render(scene, camera, frame,
                  {.instances = mask, .positions = points, .view_depth = metres});
  rastrum::io::write_npy("robot_depth.npy", metres);
  rastrum::io::write_npy("robot_mask.npy", mask);
  rastrum::io::write_npy("robot_points.npy", points);

  if (const auto pick = renderer.pick(scene, camera, frame, 320, 240))
    std::printf("at (320, 240): instance %lld, triangle %llu, %.3f m away\n",
                static_cast<long long>(pick->instance_id),
                static_cast<unsigned long long>(pick->primitive), pick->view_depth);
}
