// SPDX-License-Identifier: BSD-3-Clause
#include "frame_renderer.hpp"

#include <algorithm>
#include <cstddef>

#include <rastrum/render/access.hpp>

namespace rastrum::python {

FrameRenderer::FrameRenderer(const RendererOptions& options)
    : renderer_(options), scratch_(options) {
  const parallel::Threads* const threads = RendererAccess::threads(renderer_);
  of_workers_.resize(threads == nullptr ? 0 : static_cast<std::size_t>(threads->concurrency()));
}

void FrameRenderer::draw_all(
    std::size_t pictures, std::int64_t pixels,
    const std::function<void(Renderer& by, Scratch& scratch, std::size_t i)>& draw, StopToken stop,
    const std::function<void(std::size_t)>& after) {
  RendererOptions one = renderer_.options();
  one.threads = 1;
  const auto alone = [&](Renderer& by, std::size_t worker, std::size_t i) {
    std::unique_ptr<Scratch>& scratch = of_workers_[worker];
    if (scratch == nullptr) scratch = std::make_unique<Scratch>(one);
    draw(by, *scratch, i);
  };
  if (RendererAccess::draw_side_by_side(renderer_, pictures, pixels, alone, stop))
    return after(pictures);
  // `after` may run a caller's function, which may draw with this renderer: the lock is not held.
  for (std::size_t i = 0; i < pictures; ++i) {
    {
      const std::scoped_lock lock(mutex_);
      draw(renderer_, scratch_, i);
    }
    after(1);
  }
}

SceneView ManyShown::of(std::size_t picture, std::vector<InstanceView>& instances) const {
  const ArrayScene::Shown& shown = scenes[scenes.size() == 1 ? 0 : picture];
  if (transforms.empty()) return shown.view;
  const std::size_t size = 16 * shown.of_things.size();
  return shown.at(transforms.subspan(picture * size, size), instances);
}

std::vector<FrameStats> FrameRenderer::render(const ManyShown& shown,
                                              const std::vector<Camera>& cameras,
                                              const FrameOptions& o,
                                              const std::vector<Wanted>& outputs,
                                              const Annotations* annotations, StopToken stop,
                                              const std::function<void(std::size_t)>& after) {
  std::vector<FrameStats> stats(cameras.size());
  const bool edged = annotations != nullptr && annotations->edges;
  const bool one_scene = shown.scenes.size() == 1 && shown.transforms.empty();
  std::optional<SceneEdges> of_all;
  if (edged && one_scene)
    of_all.emplace(shown.scenes.front().view, annotations->edges->angle_degrees);
  const auto draw = [&](Renderer& by, Scratch& scratch, std::size_t i) {
    const SceneView scene = shown.of(i, scratch.instances);
    std::optional<SceneEdges> of_one;
    if (edged && !one_scene) of_one.emplace(scene, annotations->edges->angle_degrees);
    const std::optional<SceneEdges>& edges = one_scene ? of_all : of_one;
    Targets targets;
    for (const Wanted& w : outputs) w.kind->attach(targets, w.array, i, o);
    stats[i] = annotations == nullptr
                   ? by.render(scene, cameras[i], o, targets, {}, stop)
                   : scratch.annotator.render(by, scene, cameras[i], o, *annotations, targets,
                                              edges ? &*edges : nullptr, stop);
  };
  draw_all(cameras.size(), std::int64_t{o.width} * o.height, draw, stop, after);
  return stats;
}

void FrameRenderer::rasterize(std::span<const ClipTriangles> what, ImageView<Vec4> first,
                              StopToken stop) {
  const std::int64_t pixels = std::int64_t{first.width} * first.height;
  const auto draw = [&](Renderer& by, Scratch& scratch, std::size_t i) {
    ImageView<Vec4> into = first;
    into.data += i * static_cast<std::size_t>(pixels);
    scratch.clip.draw(by, what[i], into, stop);
  };
  draw_all(what.size(), pixels, draw, stop, [](std::size_t) {});
}

}  // namespace rastrum::python
