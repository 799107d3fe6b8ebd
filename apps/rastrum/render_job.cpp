#include "render_job.hpp"

#include <string>
#include <type_traits>
#include <vector>

#include "progress.hpp"
#include "timeline.hpp"

namespace rastrum::cli {

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
  if (wanted.notes != nullptr)
    wanted.annotator->add_targets(*wanted.notes, options.width, options.height, targets);
  pictures.targets = targets;
  return targets;
}

namespace {

/// Prepares the surface that annotations look at besides a frame's own targets.
void add_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                 const FrameOptions& frame, const Wanted& wanted) {
  if (wanted.notes != nullptr)
    wanted.annotator->add_surface(renderer, scene, camera, frame, *wanted.notes);
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
    add_surface(renderer, scene, camera, frame, wanted);
    return stats;
  }
  const Targets color8 = make_targets({.color8 = true, .images = {}}, frame, pictures);
  for (int i = 0; i < frames; ++i) {
    progress.show("rendering frame " + std::to_string(i + 1) + " of " + std::to_string(frames));
    stats.push_back(timed_render(renderer, scene, camera, frame, color8, timeline,
                                 "frame " + std::to_string(i)));
  }
  wanted.color8 = false;
  const Targets others = make_targets(wanted, frame, pictures);
  if (wanted.color || wanted.depth || wanted.ids || wanted.overdraw || wanted.errors ||
      !wanted.images.empty() || !others.view_depth.empty() || !others.ids.empty() ||
      !others.depth.empty())
    timeline.measure("other images", "images",
                     [&] { renderer.render(scene, camera, frame, others); });
  add_surface(renderer, scene, camera, frame, wanted);
  pictures.targets.color8 = color8.color8;
  return stats;
}

}  // namespace rastrum::cli
