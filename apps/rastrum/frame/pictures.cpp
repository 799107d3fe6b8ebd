// SPDX-License-Identifier: BSD-3-Clause
#include "pictures.hpp"

#include <string>
#include <type_traits>
#include <vector>

#include "job/progress.hpp"

namespace rastrum::cli {
namespace {

/// Bytes per pixel of a rank beside its targets: keys, words, other ranks' words, and words on
/// their way.
constexpr std::uint64_t kBytesOfWords = 48;
/// Bytes per sample if there are several: a fragment as held, packed, and received.
constexpr std::uint64_t kBytesOfSample = 3 * 24;
/// Bands are whole bins (RanksOptions::rows).
constexpr int kStep = 64;

void add_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                 const FrameOptions& frame, const Wanted& wanted) {
  if (wanted.notes != nullptr)
    wanted.annotator->add_surface(renderer, scene, camera, frame, *wanted.notes);
}

/// Times are of the whole call, from the mesh in memory to the finished image; the time before the
/// rasterizer's own clock is the stage "prepare".
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

}  // namespace

Wanted wanted_of(const RenderArguments& a, const Annotations* notes, Annotator* annotator) {
  const bool floats =
      a.outputs.color.format == Format::exr || a.outputs.color.format == Format::npy;
  Wanted wanted{.color8 = (a.outputs.color && !floats) || a.outputs.errors || a.hashes_alone(),
                .color = a.outputs.color && floats,
                .depth = static_cast<bool>(a.outputs.depth),
                .ids = a.outputs.ids || a.outputs.objects,
                .overdraw = static_cast<bool>(a.outputs.heatmap),
                .errors = static_cast<bool>(a.outputs.errors),
                .images = {},
                .notes = notes,
                .annotator = annotator};
  for (const FrameImage& image : a.outputs.images) wanted.images.push_back(image.name);
  return wanted;
}

int rows_at_once(const RenderArguments& a, std::uint64_t bytes) {
  const Wanted wanted = wanted_of(a);
  // With a tone, one more image for linear light and its depth.
  std::uint64_t of_pixel = kBytesOfWords + sizeof(Vec4) + sizeof(float);
  of_pixel += wanted.color8 ? sizeof(Rgba8) : 0;
  of_pixel += wanted.color ? sizeof(Vec4) : 0;
  of_pixel += wanted.depth ? sizeof(float) : 0;
  of_pixel += wanted.ids ? sizeof(std::int64_t) : 0;
  of_pixel += wanted.images.size() * sizeof(Vec4);
  if (a.render.samples > 1)
    of_pixel += kBytesOfSample * static_cast<std::uint64_t>(a.render.samples);
  const std::uint64_t of_step = of_pixel * kStep * static_cast<std::uint64_t>(a.render.width);
  const std::uint64_t steps = std::max<std::uint64_t>(bytes / of_step, 1);
  const auto height = static_cast<std::uint64_t>(a.render.height);
  return steps * kStep >= height ? 0 : static_cast<int>(steps) * kStep;
}

const char* why_whole(const RenderArguments& a, const Annotations& notes) {
  if (notes.any()) return "words and effects need";
  if (a.render.shader == Shader::depth) return "the shader depth needs";
  if (a.render.environment_behind) return "an environment behind the picture needs";
  return a.hash ? "--hash needs" : nullptr;
}

Targets make_targets(const Wanted& wanted, Size size, Pictures& pictures) {
  Targets targets;
  const auto add = [&](bool want, auto& image, auto& target) {
    if (!want) return;
    if (image.empty()) image = std::remove_reference_t<decltype(image)>(size.width, size.height);
    target = image.view();
  };
  add(wanted.color8, pictures.color8, targets.color8);
  add(wanted.color, pictures.color, targets.color);
  add(wanted.depth, pictures.depth, targets.depth);
  add(wanted.ids, pictures.ids, targets.ids);
  add(wanted.overdraw, pictures.overdraw, targets.overdraw);
  add(wanted.errors, pictures.errors, targets.errors);
  add_frame_images(wanted.images, size.width, size.height, pictures.images, targets);
  if (wanted.notes != nullptr)
    wanted.annotator->add_targets(*wanted.notes, size.width, size.height, targets);
  pictures.targets = targets;
  return targets;
}

void annotate(const Pictures& pictures, const Annotations& notes, const SceneView& scene,
              const FrameOptions& frame, Annotator& annotator) {
  if (!pictures.color8.empty() || !pictures.color.empty())
    annotator.draw(notes, scene, pictures.camera, frame.background, pictures.targets);
}

std::vector<FrameStats> render_frames(Renderer& renderer, const SceneView& scene,
                                      const Camera& camera, const FrameOptions& frame,
                                      Wanted wanted, bool timed, int frames, Pictures& pictures,
                                      Timeline& timeline, Progress& progress) {
  std::vector<FrameStats> stats;
  const Size size{frame.width, frame.height};
  pictures.camera = camera;
  if (!timed) {
    progress.show("rendering");
    const Targets all = make_targets(wanted, size, pictures);
    stats.push_back(timed_render(renderer, scene, camera, frame, all, timeline, "frame"));
    add_surface(renderer, scene, camera, frame, wanted);
    return stats;
  }
  const Targets color8 = make_targets({.color8 = true, .images = {}}, size, pictures);
  for (int i = 0; i < frames; ++i) {
    progress.show("rendering frame " + std::to_string(i + 1) + " of " + std::to_string(frames));
    stats.push_back(timed_render(renderer, scene, camera, frame, color8, timeline,
                                 "frame " + std::to_string(i)));
  }
  wanted.color8 = false;
  const Targets others = make_targets(wanted, size, pictures);
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
