// SPDX-License-Identifier: BSD-3-Clause
#include "scene_job.hpp"

#include <algorithm>
#include <string>

#include "camera.hpp"
#include "json_file.hpp"

namespace rastrum::cli {
namespace {

/// Refuses what this machine or build cannot do.
Renderer checked_renderer(const family::Options& options) {
  check(options);
  return family::make_renderer(options, options);
}

}  // namespace

SceneJob::SceneJob(const RenderArguments& a)
    : RenderJob(a, a.quiet), renderer(checked_renderer(a.render)) {
  if (!a.path.empty())
    static_cast<void>(read_json(a.path));  // refuses a wrong file before a large scene is read
  const double begin = timeline.now_ms();
  inputs = load_inputs(a.inputs, a.normals, timeline, progress, a.reading);
  check_files(a);
  set_sizes(inputs.scene, a.sizes);
  load_ms = timeline.now_ms() - begin;
  parts = inputs.parts;
  if (!quiet) warn_of_inputs();

  const bool moves = pose_first();
  light();
  set_scalars(a.annotations.scalars, inputs.scene);
  binding.emplace(inputs.scene);
  if (a.prepares) {
    if (moves)
      throw UsageError("--prepare",
                       "needs meshes that stay as they are, but this file moves along --path");
    timeline.measure("prepare", "prepare", [&] { binding->prepare(render.threads); });
  }
  render.shader = shader_of(render.shader, inputs.has_materials);
  camera = choose_camera(a.view, inputs.scene, binding->view(), {render.width, render.height});
  if (a.view.leaves_room())
    camera = with_room(notes, camera, binding->view(), render.width, render.height);

  SceneAt moving;
  if (moves)
    moving = [this](double seconds) {
      pose_inputs(inputs, arguments.normals, seconds, animation());
      light();
      return posed_.emplace(inputs.scene).view();
    };
  if (a.turntable != 0)
    pictures = on_turntable(a.turntable, binding->view(), a.view, camera);
  else if (!a.path.empty())
    pictures = along_path(a.path, a.pictures_a_second(), binding->view(), moving, a.view, camera);
  else
    pictures = {1, [this](std::size_t) -> Sequence::Shot { return {binding->view(), camera}; }};
}

/// Poses the inputs for --time. Returns whether they move along the path.
bool SceneJob::pose_first() {
  const RenderArguments& a = arguments;
  if (!a.time_s && a.path.empty()) return false;
  const std::size_t count = animation_count(inputs.scene);
  if (a.animation && animation() >= count)
    throw UsageError("--animation", "there is no animation " + std::to_string(animation()) +
                                        ": the files have " + std::to_string(count));
  if (count == 0) {
    if (a.time_s && !quiet) warn("--time: no input has an animation");
    return false;
  }
  if (a.time_s) pose_inputs(inputs, a.normals, *a.time_s, animation());
  return !a.time_s;
}

std::size_t SceneJob::animation() const {
  return static_cast<std::size_t>(arguments.animation.value_or(0));
}

/// Includes the lights of the inputs.
void SceneJob::light() {
  if (!arguments.lights.of_files) return;
  render.lights = arguments.render.lights;
  add_file_lights(inputs.scene, render.lights);
}

void SceneJob::warn_of_inputs() {
  const Scene& scene = inputs.scene;
  if (!scene.warnings.empty()) progress.clear();
  for (const std::string& w : scene.warnings) warn(w);
  const auto blended = std::ranges::count(scene.materials, AlphaMode::blend, &Material::alpha_mode);
  if (blended != 0 && render.transparency.method == Transparency::none)
    warn(std::to_string(blended) + " of " + std::to_string(scene.materials.size()) +
         " materials ask for blending (alphaMode BLEND) and are drawn opaque, as --transparency "
         "none says");
  const AnnotationOptions& said = arguments.annotations;
  if (const std::string missing = missing_glyphs(said.words, said.scalars.words());
      !missing.empty())
    warn(missing);
}

}  // namespace rastrum::cli
