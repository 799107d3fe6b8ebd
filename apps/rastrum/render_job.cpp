#include "render_job.hpp"

#include <string>
#include <type_traits>
#include <vector>

#include "progress.hpp"
#include "timeline.hpp"

namespace rastrum::cli {
namespace {

/// Allocates what is wanted and returns the views.
Targets make_targets(const Wanted& wanted, const FrameOptions& options, Pictures& pictures) {
  Targets targets;
  const auto add = [&](bool want, auto& image, auto& target) {
    if (!want) return;
    if (image.empty())
      image = std::remove_reference_t<decltype(image)>(options.width, options.height);
    target = image.view();
  };
  add(wanted.color8, pictures.color8, targets.color8);
  add(wanted.color, pictures.color, targets.color);
  add(wanted.depth, pictures.depth, targets.depth);
  add(wanted.ids, pictures.ids, targets.ids);
  add(wanted.overdraw, pictures.overdraw, targets.overdraw);
  add(wanted.errors, pictures.errors, targets.errors);
  add_frame_images(wanted.images, options.width, options.height, pictures.images, targets);
  if (wanted.surface) {
    add(targets.view_depth.empty(), pictures.view_depth, targets.view_depth);
    add(wanted.edges && targets.camera_normals.empty(), pictures.camera_normals,
        targets.camera_normals);
    add(wanted.edges && targets.instances.empty(), pictures.instances, targets.instances);
    pictures.surface = {targets.view_depth, targets.camera_normals, targets.instances};
  }
  return targets;
}

/// The surface for effects once more, where textures blend.
void draw_solid_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                        const FrameOptions& frame, const Wanted& wanted, Pictures& pictures) {
  if (!wanted.surface || frame.transparency.method == Transparency::none) return;
  const std::vector<Material> materials = materials_of_surface(scene);
  if (materials.empty()) return;
  const auto view = [&](auto& image) {
    if (image.empty()) image = std::remove_reference_t<decltype(image)>(frame.width, frame.height);
    return image.view();
  };
  SceneView solid = scene;
  solid.materials = materials;
  Targets targets{.view_depth = view(pictures.solid_depth)};
  if (wanted.edges) {
    targets.camera_normals = view(pictures.solid_normals);
    targets.instances = view(pictures.solid_instances);
  }
  renderer.render(solid, camera, frame, targets);
  pictures.surface = {targets.view_depth, targets.camera_normals, targets.instances};
}

}  // namespace

FrameStats timed_render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets, Timeline& timeline,
                        const std::string& label) {
  const double begin = timeline.now_ms();
  FrameStats stats = renderer.render(scene, camera, frame, targets);
  const double whole = timeline.now_ms() - begin;
  const double before = whole - stats.frame_ms;
  for (StageTime& stage : stats.stages) {
    stage.begin_ms += before;
    stage.end_ms += before;
  }
  stats.stages.insert(stats.stages.begin(), {"prepare", 0, before});
  stats.frame_ms = whole;
  timeline.add_frame(label, begin, stats);
  return stats;
}

std::vector<FrameStats> render_frames(Renderer& renderer, const SceneView& scene,
                                      const Camera& camera, const FrameOptions& frame,
                                      Wanted wanted, bool timed, int frames, Pictures& pictures,
                                      Timeline& timeline, Progress& progress) {
  std::vector<FrameStats> stats;
  if (!timed) {
    progress.show("rendering");
    const Targets all = make_targets(wanted, frame, pictures);
    stats.push_back(timed_render(renderer, scene, camera, frame, all, timeline, "frame"));
    draw_solid_surface(renderer, scene, camera, frame, wanted, pictures);
    return stats;
  }
  const Targets color8 = make_targets({.color8 = true, .images = {}}, frame, pictures);
  for (int i = 0; i < frames; ++i) {
    progress.show("rendering frame " + std::to_string(i + 1) + " of " + std::to_string(frames));
    stats.push_back(timed_render(renderer, scene, camera, frame, color8, timeline,
                                 "frame " + std::to_string(i)));
  }
  wanted.color8 = false;
  if (wanted.color || wanted.depth || wanted.ids || wanted.overdraw || wanted.errors ||
      wanted.surface || !wanted.images.empty()) {
    const Targets others = make_targets(wanted, frame, pictures);
    timeline.measure("other images", "images",
                     [&] { renderer.render(scene, camera, frame, others); });
    draw_solid_surface(renderer, scene, camera, frame, wanted, pictures);
  }
  return stats;
}

}  // namespace rastrum::cli
