// SPDX-License-Identifier: BSD-3-Clause
#include "sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/core/angle.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/rules/clip.hpp>

#include "camera_path.hpp"
#include "path_keys.hpp"

namespace rastrum::cli {
namespace {

/// Rodrigues' rotation about an axis through `centre`; exactly the identity at 0°.
Mat4d turn(const double (&axis)[3], const double (&centre)[3], double degrees) {
  const SinCos a = sin_cos_degrees(degrees);
  const double cross[3][3] = {
      {0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
  Mat4d m = Mat4d::identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      m.m[i][j] = (i == j ? a.cos : 0) + axis[i] * axis[j] * (1 - a.cos) + cross[i][j] * a.sin;
    m.m[i][3] = centre[i] - (m.m[i][0] * centre[0] + m.m[i][1] * centre[1] + m.m[i][2] * centre[2]);
  }
  return m;
}

/// Throws for a camera without a direction, which may lie even between two valid keys.
void check_between(const Camera& camera, double time_s) {
  try {
    static_cast<void>(world_to_clip(camera, 1, 1));
  } catch (const Error& e) {
    throw Error(Errc::bad_format, "at " + std::to_string(time_s) + " s: " + e.what() +
                                      "; add a key, or take \"interpolation\": \"linear\"");
  }
}

class Turntable {
 public:
  Turntable(const SceneView& scene, const Camera& camera, std::size_t count)
      : scene_(scene),
        turned_(scene.instances.begin(), scene.instances.end()),
        axis_{camera.up.x, camera.up.y, camera.up.z},
        target_{camera.target.x, camera.target.y, camera.target.z},
        count_(count) {
    const double l = std::sqrt(axis_[0] * axis_[0] + axis_[1] * axis_[1] + axis_[2] * axis_[2]);
    for (double& a : axis_) a /= l;
  }

  [[nodiscard]] SceneView at(std::size_t number) {
    const Mat4d m = matrix(number);
    for (std::size_t i = 0; i < turned_.size(); ++i)
      turned_[i].object_to_world = m * scene_.instances[i].object_to_world;
    return {turned_, scene_.materials, scene_.textures};
  }

  /// The nearest and the farthest planes from place_planes on the way round.
  [[nodiscard]] std::pair<float, float> planes(Camera camera, const BoundingSphere& sphere) const {
    float near = std::numeric_limits<float>::infinity(), far = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const raster::Vec4d centre = raster::transform_point(matrix(i), sphere.centre);
      place_planes(camera, {{centre.x, centre.y, centre.z}, sphere.radius});
      near = std::min(near, camera.near_plane);
      far = std::max(far, camera.far_plane);
    }
    return {near, far};
  }

 private:
  [[nodiscard]] Mat4d matrix(std::size_t number) const {
    return turn(axis_, target_, 360 * static_cast<double>(number) / static_cast<double>(count_));
  }

  SceneView scene_;
  std::vector<InstanceView> turned_;
  double axis_[3], target_[3];
  std::size_t count_;
};

}  // namespace

Sequence along_path(const std::filesystem::path& file, double fps, const SceneView& scene,
                    const SceneAt& moving, const ViewOptions& options, const Camera& base) {
  const CameraPath path = read_path(file, base);
  const std::vector<double> times = of_path(file, [&] {
    std::vector<double> all = frame_times(path.first_s(), path.last_s(), fps);
    // Checked before the first picture is drawn.
    for (const double t : all) check_between(path.at(t), t);
    return all;
  });
  const bool moves_planes = !path.first().has_planes && !options.near_plane;
  return {times.size(), [=, sphere = bounding_sphere(scene)](std::size_t i) -> Sequence::Shot {
            Camera camera = path.at(times[i]);
            const SceneView now = moving ? moving(times[i]) : scene;
            if (moves_planes) place_planes(camera, moving ? bounding_sphere(now) : sphere);
            return {now, camera};
          }};
}

Sequence on_turntable(int count, const SceneView& scene, const ViewOptions& options,
                      Camera camera) {
  const auto pictures = static_cast<std::size_t>(count);
  const auto table = std::make_shared<Turntable>(scene, camera, pictures);
  // The tight fit has planes for the whole turn.
  if (options.fit == Fit::sphere || options.eye || options.target) {
    const auto [near, far] = table->planes(camera, bounding_sphere(scene));
    if (!options.near_plane) camera.near_plane = near;
    if (!options.far_plane && camera.orthographic) camera.far_plane = far;
  }
  return {pictures, [=](std::size_t i) -> Sequence::Shot { return {table->at(i), camera}; }};
}

}  // namespace rastrum::cli
