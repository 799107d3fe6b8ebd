// SPDX-License-Identifier: BSD-3-Clause
#include "camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <rastrum/error.hpp>

#include "json_file.hpp"
#include "parse/arguments.hpp"
#include "path_keys.hpp"

namespace rastrum::cli {
namespace {

template <Vec3d Camera::*vector, double Vec3d::*component>
constexpr PathColumn<Camera> kCurve{[](const Camera& c) { return (c.*vector).*component; },
                                    [](Camera& c, double value) { (c.*vector).*component = value; },
                                    Tangent::curve};
template <float Camera::*scalar>
constexpr PathColumn<Camera> kBounded{
    [](const Camera& c) { return double{c.*scalar}; },
    [](Camera& c, double value) { c.*scalar = static_cast<float>(value); }, Tangent::monotone};
constexpr PathColumn<Camera> kColumns[] = {kCurve<&Camera::eye, &Vec3d::x>,
                                           kCurve<&Camera::eye, &Vec3d::y>,
                                           kCurve<&Camera::eye, &Vec3d::z>,
                                           kCurve<&Camera::target, &Vec3d::x>,
                                           kCurve<&Camera::target, &Vec3d::y>,
                                           kCurve<&Camera::target, &Vec3d::z>,
                                           kCurve<&Camera::up, &Vec3d::x>,
                                           kCurve<&Camera::up, &Vec3d::y>,
                                           kCurve<&Camera::up, &Vec3d::z>,
                                           kBounded<&Camera::fov_rad>,
                                           kBounded<&Camera::orthographic_height>,
                                           kBounded<&Camera::near_plane>,
                                           kBounded<&Camera::far_plane>};

float to_float(const JsonFields& fields, const char* name, double value) {
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    fields.fail(name, "the number is too large");
  return static_cast<float>(value);
}

void read_vec3(JsonFields& fields, const char* name, Vec3d& into) {
  if (const auto v = fields.numbers(name, 3)) into = {(*v)[0], (*v)[1], (*v)[2]};
}

void read_planes(JsonFields& fields, PathKey& key) {
  Camera& c = key.camera;
  if (const auto n = fields.number("near")) {
    c.near_plane = to_float(fields, "near", *n);
    key.has_planes = true;
  }
  const nlohmann::ordered_json* far = fields.value("far");
  if (far != nullptr && *far == "inf")
    c.far_plane = std::numeric_limits<float>::infinity();
  else if (far != nullptr)
    c.far_plane = to_float(fields, "far", *fields.number("far"));
  if (far != nullptr && !key.has_planes) fields.fail("far", "needs near beside it");
}

/// Refuses cameras that the renderer would refuse later, with the place in the file.
void check_camera(const JsonFields& fields, const PathKey& key) {
  const Camera& c = key.camera;
  if (c.eye == c.target) fields.fail("eye", "eye and target must differ");
  if (length(cross(c.up, c.target - c.eye)) == 0)
    fields.fail("up", "must not be zero or along the view direction");
  if (!key.has_planes) return;
  if (!c.orthographic && !(c.near_plane > 0)) fields.fail("near", "must be greater than 0");
  if (!(c.near_plane < c.far_plane)) fields.fail("far", "must be greater than near");
  if (c.orthographic && !std::isfinite(c.far_plane))
    fields.fail("far", "must be finite for an orthographic camera");
}

PathKey read_key(const JsonFields::Element& element, const PathKey& before, bool first) {
  JsonFields fields(*element.value, element.place);
  PathKey key = before;
  Camera& c = key.camera;
  key.time_s = read_key_time(fields, first ? std::nullopt : std::optional(before.time_s));
  read_vec3(fields, "eye", c.eye);
  read_vec3(fields, "target", c.target);
  read_vec3(fields, "up", c.up);
  const auto fov_deg = fields.number("fov");
  const auto height = fields.number("orthographic");
  if (fov_deg && height) fields.fail("orthographic", "cannot go with fov");
  if (fov_deg && !(*fov_deg > 0 && *fov_deg < 180))
    fields.fail("fov", "must lie between 0 and 180 degrees");
  if (height && !(*height > 0)) fields.fail("orthographic", "the height must be greater than 0");
  if (fov_deg) c.fov_rad = static_cast<float>(*fov_deg * kDegree);
  if (height) c.orthographic_height = to_float(fields, "orthographic", *height);
  if (fov_deg || height) c.orthographic = height.has_value();
  read_planes(fields, key);
  fields.finish();
  if (!first && c.orthographic != before.camera.orthographic)
    fields.fail("a path is orthographic in all keys or in none");
  if (!first && key.has_planes != before.has_planes)
    fields.fail("near", "must be given in the first key or in none");
  if (!first && std::isinf(c.far_plane) != std::isinf(before.camera.far_plane))
    fields.fail("far", "must be inf in all keys or in none");
  check_camera(fields, key);
  return key;
}

}  // namespace

CameraPath read_path(const std::filesystem::path& file, const Camera& base) {
  auto [keys, interpolation] = read_path_keys(file, PathKey{.camera = base}, read_key);
  return {std::move(keys), interpolation, kColumns};
}

nlohmann::ordered_json camera_json(const Camera& c, bool planes) {
  const auto vec = [](Vec3d v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json entry{{"eye", vec(c.eye)}, {"target", vec(c.target)}, {"up", vec(c.up)}};
  if (c.orthographic)
    entry["orthographic"] = c.orthographic_height;
  else
    entry["fov"] = c.fov_rad / kDegree;
  if (!planes) return entry;
  entry["near"] = c.near_plane;
  if (std::isinf(c.far_plane))
    entry["far"] = "inf";
  else
    entry["far"] = c.far_plane;
  return entry;
}

void write_path(const std::filesystem::path& file, std::span<const PathKey> keys) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PathKey& key : keys) {
    nlohmann::ordered_json entry{{"time", key.time_s}};
    entry.update(camera_json(key.camera, key.has_planes));
    list.push_back(std::move(entry));
  }
  write_json(file, {{"keys", std::move(list)}});
}

std::vector<double> frame_times(double first_s, double last_s, double fps) {
  constexpr double kMost = 1e6;
  // Rounding must not lose the last picture of a path of whole frames.
  const double count = std::floor((last_s - first_s) * fps * (1 + 1e-12)) + 1;
  if (!(count <= kMost))
    throw Error(Errc::invalid_argument,
                "the path has " + std::to_string(count) +
                    " pictures, and at most a million are possible; lower --fps");
  std::vector<double> times(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = std::min(first_s + static_cast<double>(i) / fps, last_s);
  return times;
}

}  // namespace rastrum::cli
