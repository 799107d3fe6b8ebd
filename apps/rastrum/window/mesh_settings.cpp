// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_settings.hpp"

#include <algorithm>
#include <limits>

namespace rastrum::cli::window {

ClipPlane Section::plane(const Vec3d& direction) const {
  const double side = below ? -1 : 1;
  // Avoids −0.
  const auto turned = [side](double v) { return v == 0 ? 0 : side * v; };
  return {{turned(direction.x), turned(direction.y), turned(direction.z)}, turned(-at)};
}

ScalarRange reach(const Bounds& box, const Vec3d& direction) {
  ScalarRange all{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  for (const double x : {box.min.x, box.max.x})
    for (const double y : {box.min.y, box.max.y})
      for (const double z : {box.min.z, box.max.z}) {
        const double at = dot(Vec3d{x, y, z}, direction);
        all = {std::min(all.low, at), std::max(all.high, at)};
      }
  return all;
}

ViewSection section_of_view(const Camera& camera, const Bounds& box) {
  ViewSection section;
  const Vec3d way = camera.target - camera.eye;
  const double far = length(way);
  section.direction = {way.x / far, way.y / far, way.z / far};
  const ScalarRange all = reach(box, section.direction);
  section.on = true;
  section.at = (all.low + all.high) / 2;
  section.below = false;
  return section;
}

std::vector<ClipPlane> MeshSettings::cuts() const {
  constexpr Vec3d kAxes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<ClipPlane> planes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (sections[axis].on) planes.push_back(sections[axis].plane(kAxes[axis]));
  if (view_section.on) planes.push_back(view_section.plane(view_section.direction));
  return planes;
}

family::Options MeshSettings::frame(int width, int height) const {
  family::Options options = render;
  options.width = width;
  options.height = height;
  if (!lights.empty()) {
    options.environment_behind = false;
    options.lights.clear();
    if (lights == "studio") options.lights = light_kit();
    if (lights == "headlight") options.lights = {headlight()};
    if (lights == "file") options.lights = file_lights;
  } else if (adds_file_lights) {
    options.lights.insert(options.lights.end(), file_lights.begin(), file_lights.end());
  }
  if (options.lights.empty()) options.shadows = false;
  const std::vector<ClipPlane> planes = cuts();
  options.clip_planes.insert(options.clip_planes.end(), planes.begin(), planes.end());
  return options;
}

}  // namespace rastrum::cli::window
