// SPDX-License-Identifier: BSD-3-Clause
// The module for browsers has this beside rastrum.h: scenes that the library itself makes, and
// views by name.
#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/c/handles.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/light.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::c {
namespace {

/// A handle that keeps the scene, which the renderer sees as a program does.
rastrum_scene* handle_of(Scene read) {
  auto handle = std::make_unique<rastrum_scene>();
  auto kept = std::make_shared<const Scene>(std::move(read));
  const SceneBinding binding(*kept);
  for (InstanceView instance : binding.view().instances) {
    auto geometry = std::make_shared<GeometryView>(
        instance.geometry.visit([](const auto& view) { return GeometryView(view); }));
    instance.geometry = *geometry;
    handle->instances.push_back(instance);
    handle->geometries.push_back(std::move(geometry));
  }
  handle->color_maps = kept->scalar_mappings;
  handle->read = std::move(kept);
  return handle.release();
}

}  // namespace

extern "C" {

/// C++'s runtime asks it to destroy thread_local objects at a thread's end. The one thread ends
/// with the module.
int __cxa_thread_atexit(void (*)(void*), void*, void*) {
  return 0;
}

/// Reads a file, by its extension. Meshes without normals get those of `rastrum render --crease`,
/// in [0, 180]. Null: rastrum_error_text says why not.
rastrum_scene* rastrum_wasm_read(const char* file, double crease_deg) {
  return made([&] {
    Scene read = io::read_scene(&at(file, "the file"));
    for (Mesh& mesh : read.meshes)
      if (mesh.normals.empty())
        mesh.normals = crease_normals(mesh.view().positions, mesh.indices, crease_deg);
    return handle_of(std::move(read));
  });
}

/// Makes a shape, as `teapot` or `hairball?strands=100`; null as above.
rastrum_scene* rastrum_wasm_shape(const char* shape) {
  return made([&] { return handle_of(shapes::scene_from_spec(&at(shape, "the shape"))); });
}

double rastrum_wasm_primitives(const rastrum_scene* scene) {
  return scene == nullptr || scene->read == nullptr
             ? 0
             : static_cast<double>(scene->read->primitive_count());
}

/// A thing that the reader found odd or left out: number i, or null beyond the last.
const char* rastrum_wasm_warning(const rastrum_scene* scene, size_t i) {
  if (scene == nullptr || scene->read == nullptr || i >= scene->read->warnings.size())
    return nullptr;
  return scene->read->warnings[i].c_str();
}

/// Looks as `rastrum render --view NAME --azimuth A --elevation E` does, for rastrum_camera_fit to
/// place.
rastrum_status rastrum_wasm_view(rastrum_camera* camera, const char* name, double azimuth_deg,
                                 double elevation_deg) {
  return guarded([&] {
    const std::string_view wanted = &at(name, "the name of the view");
    const std::vector<std::string_view> names = view_names();
    const auto found = std::ranges::find(names, wanted);
    require(found != names.end(), "no view is called '", wanted, "'");
    const View view = turned(view_of(static_cast<ViewName>(found - names.begin())),
                             {azimuth_deg, elevation_deg, 0});
    Camera& c = at(camera, "the camera").camera;
    c.matrix.reset();
    c.eye = {};
    c.target = view.direction;
    c.up = view.up;
  });
}

/// A picture `times` as large.
rastrum_status rastrum_wasm_zoom(rastrum_camera* camera, double times) {
  return guarded([&] {
    Camera& c = at(camera, "the camera").camera;
    c = zoomed(c, times);
  });
}

/// The lights of `--lights studio`.
rastrum_status rastrum_wasm_add_studio(rastrum_frame* frame) {
  return guarded([&] {
    std::vector<Light>& lights = at(frame, "the frame").options.lights;
    for (const Light& light : light_kit()) lights.push_back(light);
  });
}

}  // extern "C"
}  // namespace rastrum::c
