// SPDX-License-Identifier: BSD-3-Clause
// Renderers of the C interface.
#include <rastrum/c/handles.hpp>

#include <string_view>

#include <rastrum/device.hpp>

namespace rastrum::c {
namespace {

/// Makes the renderer again with its options changed by f(options).
template <class F>
rastrum_status with_options(rastrum_renderer* renderer, const F& f) noexcept {
  return guarded([&] {
    RendererOptions options = at(renderer, "the renderer").options;
    f(options);
    renderer->renderer = Renderer(options);
    renderer->options = options;
  });
}

Device device_from_name(std::string_view wanted) {
  for (const Device d : {Device::serial, Device::threads, Device::cuda, Device::automatic})
    if (name(d) == wanted) return d;
  reject("no device is called '", wanted, "'; there are serial, threads, cuda, auto");
}

}  // namespace

#pragma GCC visibility push( \
    default)  // as in rastrum.h, whose declarations are in another namespace
extern "C" {

rastrum_renderer* rastrum_renderer_new() {
  return made([] { return new rastrum_renderer; });
}

void rastrum_renderer_free(rastrum_renderer* renderer) {
  delete renderer;
}

rastrum_status rastrum_renderer_set_threads(rastrum_renderer* renderer, int threads) {
  return with_options(renderer, [&](RendererOptions& o) { o.threads = threads; });
}

rastrum_status rastrum_renderer_set_memory_limit(rastrum_renderer* renderer, uint64_t bytes) {
  return with_options(renderer, [&](RendererOptions& o) { o.memory_limit = bytes; });
}

rastrum_status rastrum_renderer_set_device(rastrum_renderer* renderer, const char* device) {
  return with_options(renderer, [&](RendererOptions& o) {
    o.device = device_from_name(&at(device, "the name of the device"));
  });
}

rastrum_status rastrum_render(rastrum_renderer* renderer, const rastrum_scene* scene,
                              const rastrum_camera* camera, const rastrum_frame* frame) {
  return guarded([&] {
    Renderer& draws = at(renderer, "the renderer").renderer;
    const SceneView view = at(scene, "the scene").view();
    const Camera& eye = at(camera, "the camera").camera;
    const rastrum_frame& f = at(frame, "the frame");
    (void)draws.render(view, eye, f.options, f.targets, {}, f.stop.get_token());
  });
}

}  // extern "C"
#pragma GCC visibility pop
}  // namespace rastrum::c
