// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <rastrum/camera.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/pick.hpp>

#include "scenes.hpp"

namespace rastrum::python {
namespace {

using Numbers3 = std::array<double, 3>;

Vec3d vec3(const Numbers3& v) {
  return {v[0], v[1], v[2]};
}
Numbers3 numbers(Vec3d v) {
  return {v.x, v.y, v.z};
}

/// Centre and radius.
using Ball = std::tuple<double, double, double, double>;
BoundingSphere sphere(const std::optional<Ball>& ball) {
  if (!ball) return {};
  const auto& [x, y, z, radius] = *ball;
  return {{x, y, z}, radius};
}

constexpr double kPi = 3.14159265358979323846;

Camera look_at(const Numbers3& eye, const Numbers3& target, const Numbers3& up, double fov,
               std::optional<double> height, std::optional<double> near, std::optional<double> far,
               const std::optional<Ball>& ball) {
  Camera c;
  c.eye = vec3(eye);
  c.target = vec3(target);
  c.up = vec3(up);
  c.fov_rad = static_cast<float>(fov * kPi / 180);
  c.orthographic = height.has_value();
  if (height) c.orthographic_height = static_cast<float>(*height);
  const BoundingSphere scene = sphere(ball);
  c.near_plane =
      static_cast<float>(near ? *near : nearest_plane(c.eye, length(c.eye - c.target), scene));
  // Ten radii beyond the scene's centre, so that moving things stay before the far plane.
  c.far_plane = static_cast<float>(far ? *far : length(c.eye - scene.centre) + 10 * scene.radius);
  (void)world_to_clip(c, 1, 1);  // throws for a number out of range
  return c;
}

Camera fit(const ArrayScene& scene, const Numbers3& direction, const Numbers3& up, double fov,
           bool orthographic, int width, int height) {
  const Camera view{.eye = {},
                    .target = vec3(direction),
                    .up = vec3(up),
                    .fov_rad = static_cast<float>(fov * kPi / 180),
                    .orthographic = orthographic};
  return fit_picture(scene.show().view, view, width, height);
}

/// (direction, up)
std::pair<Numbers3, Numbers3> view(const std::string& name, const Numbers3& up) {
  const std::vector<std::string_view> names = view_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i]) {
      const View v = view_of(static_cast<ViewName>(i), vec3(up));
      return {numbers(v.direction), numbers(v.up)};
    }
  std::string all;
  for (const std::string_view n : names) all += (all.empty() ? "" : ", ") + std::string(n);
  throw Error(Errc::invalid_argument, "view: there is no " + name + "; take one of " + all);
}

Camera opencv(const Array& k, const Array& pose, int width, int height, std::optional<double> near,
              double first_centre, const std::optional<Ball>& ball) {
  if (k.ndim() != 2 || k.shape(0) != 3 || k.shape(1) != 3 || k.dtype() != nb::dtype<double>())
    throw Error(Errc::invalid_argument, "K: must be (3, 3) of float64");
  const auto at = [&](std::int64_t i, std::int64_t j) {
    return static_cast<const double*>(k.data())[i * k.stride(0) + j * k.stride(1)];
  };
  if (at(1, 0) != 0 || at(2, 0) != 0 || at(2, 1) != 0 || at(2, 2) != 1)
    throw Error(Errc::invalid_argument, "K: must be (fx s cx; 0 fy cy; 0 0 1)");
  const Mat4d to_camera = matrix(pose, "pose");
  if (!near) {
    // There is no target; assume one unit away.
    const auto to_world = inverse(to_camera);
    const auto& m = to_world ? *to_world : to_camera;
    near = nearest_plane({m.m[0][3], m.m[1][3], m.m[2][3]}, 1, sphere(ball));
  }
  return camera_from_opencv({at(0, 0), at(1, 1), at(0, 2), at(1, 2), at(0, 1), first_centre},
                            to_camera, width, height, *near);
}

Camera of_matrix(const Array& world_to_clip, const std::string& depth) {
  const ClipDepth kind =
      depth == "opengl"        ? ClipDepth::opengl
      : depth == "zero_to_one" ? ClipDepth::zero_to_one
      : depth == "reversed"
          ? ClipDepth::reversed
          : throw Error(Errc::invalid_argument,
                        "depth: there is no " + depth + "; take opengl, zero_to_one or reversed");
  return camera_from_matrix(matrix(world_to_clip, "matrix"), kind);
}

/// out: (N, 3), x, y and depth of `points`, (N, 3), both C-contiguous float64. `depths`: (H, W) of
/// float32. Returns a byte for each point: whether it is seen; none without `depths`.
nb::bytes project_points(const Camera& camera, int width, int height, const Array& points,
                         const Output& out, const std::optional<Array>& depths) {
  const std::span<const double> from = doubles(points);
  std::vector<Vec3d> places(from.size() / 3);
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
  const std::vector<ProjectedPoint> found = project(camera, width, height, places);
  auto* to = static_cast<double*>(out.data());
  std::string seen;
  for (const ProjectedPoint& p : found) {
    *to++ = p.x;
    *to++ = p.y;
    *to++ = p.view_depth;
    if (depths)
      seen += static_cast<char>(
          is_seen(p, {static_cast<const float*>(depths->data()), width, height, width}));
  }
  return nb::bytes(seen.data(), seen.size());
}

std::array<std::array<double, 4>, 4> inverse_of(const Array& array) {
  const std::optional<Mat4d> found = inverse(matrix(array, "matrix"));
  if (!found) throw Error(Errc::invalid_argument, "matrix: it has no inverse");
  std::array<std::array<double, 4>, 4> rows{};
  for (std::size_t i = 0; i < 4; ++i) std::copy_n(found->m[i], 4, rows[i].begin());
  return rows;
}

}  // namespace

void bind_cameras(nb::module_& m) {
  using nb::arg;
  nb::class_<Camera>(m, "Camera", "A camera: where it stands and what it sees.")
      .def_prop_ro("eye", [](const Camera& c) { return numbers(c.eye); })
      .def_prop_ro("target", [](const Camera& c) { return numbers(c.target); })
      .def_prop_ro("up", [](const Camera& c) { return numbers(c.up); })
      .def_prop_ro("fov",
                   [](const Camera& c) { return static_cast<double>(c.fov_rad) * 180 / kPi; })
      .def_prop_ro("has_matrix", [](const Camera& c) { return c.matrix.has_value(); })
      .def_prop_ro("is_orthographic", [](const Camera& c) { return c.orthographic; })
      .def_prop_ro("orthographic_height", [](const Camera& c) { return c.orthographic_height; })
      .def_prop_ro("near", [](const Camera& c) { return c.near_plane; })
      .def_prop_ro("far", [](const Camera& c) { return c.far_plane; });
  m.def("look_at", look_at, arg("eye"), arg("target"), arg("up"), arg("fov"), arg("height").none(),
        arg("near").none(), arg("far").none(), arg("ball").none());
  m.def("fit", fit, arg("scene"), arg("direction"), arg("up"), arg("fov"), arg("orthographic"),
        arg("width"), arg("height"));
  m.def("project", project_points, arg("camera"), arg("width"), arg("height"), arg("points"),
        arg("out"), arg("depths").none());
  m.def("zoomed", zoomed, arg("camera"), arg("times"));
  m.def("inverse", inverse_of, arg("matrix"));
  m.def("view", view, arg("name"), arg("up"));
  m.def("opencv", opencv, arg("K"), arg("pose"), arg("width"), arg("height"), arg("near").none(),
        arg("first_centre"), arg("ball").none());
  m.def("of_matrix", of_matrix, arg("matrix"), arg("depth"));
}

}  // namespace rastrum::python
