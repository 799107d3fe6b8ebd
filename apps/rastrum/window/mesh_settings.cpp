#include "mesh_settings.hpp"

namespace rastrum::cli::window {

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
  for (int axis = 0; axis < 3; ++axis)
    if (const Section& section = sections[static_cast<std::size_t>(axis)]; section.on)
      options.clip_planes.push_back(section.plane(axis));
  return options;
}

}  // namespace rastrum::cli::window
