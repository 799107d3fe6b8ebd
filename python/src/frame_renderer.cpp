// SPDX-License-Identifier: BSD-3-Clause
#include "frame_renderer.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <utility>

namespace rastrum::python {
namespace {

/// Pictures up to this size are drawn side by side, a thread each.
constexpr std::int64_t kSmall = 512 * 512;

}  // namespace

void FrameRenderer::draw_all(std::size_t pictures, std::int64_t pixels, const Draw& draw,
                             const std::function<void()>& after) {
  const std::size_t threads = options_.threads > 0 ? static_cast<std::size_t>(options_.threads)
                                                   : std::thread::hardware_concurrency();
  const std::size_t workers = std::min(threads, pictures);
  // `after` may run a caller's function, which may draw with this renderer: the lock is not held.
  if (workers < 2 || pixels > kSmall || options_.device != Device::threads) {
    for (std::size_t i = 0; i < pictures; ++i) {
      {
        const std::scoped_lock lock(mutex_);
        draw(renderer_, scratch_, i);
      }
      after();
    }
    return;
  }
  draw_side_by_side(pictures, workers, draw);
  after();
}

void FrameRenderer::draw_side_by_side(std::size_t pictures, std::size_t workers, const Draw& draw) {
  const std::scoped_lock lock(mutex_);
  while (side_.size() < workers) {
    RendererOptions one = options_;
    one.threads = 1;
    side_.push_back(std::make_unique<Side>(one));
  }
  std::atomic<std::size_t> next{0};
  std::mutex failing;
  std::exception_ptr failure;
  {
    std::vector<std::jthread> running;
    for (std::size_t w = 0; w < workers; ++w)
      running.emplace_back([&, side = side_[w].get()] {
        try {
          for (std::size_t i; (i = next++) < pictures;) draw(side->renderer, side->scratch, i);
        } catch (...) {
          const std::scoped_lock l(failing);
          if (!failure) failure = std::current_exception();
          next = pictures;
        }
      });
  }
  if (failure) std::rethrow_exception(failure);
}

std::vector<FrameStats> FrameRenderer::render(const SceneView& scene,
                                              const std::vector<Camera>& cameras,
                                              const FrameOptions& o,
                                              const std::vector<Wanted>& outputs,
                                              const Annotations* annotations, StopToken stop,
                                              const std::function<void()>& after) {
  std::vector<FrameStats> stats(cameras.size());
  std::optional<SceneEdges> edges;
  if (annotations != nullptr && annotations->edges)
    edges.emplace(scene, annotations->edges->angle_degrees);
  const auto draw = [&](Renderer& by, Scratch& scratch, std::size_t i) {
    Targets targets;
    for (const Wanted& w : outputs) w.kind->attach(targets, w.array, i, o);
    stats[i] = annotations == nullptr
                   ? by.render(scene, cameras[i], o, targets, {}, stop)
                   : scratch.annotator.render(by, scene, cameras[i], o, *annotations, targets,
                                              edges ? &*edges : nullptr, stop);
  };
  draw_all(cameras.size(), std::int64_t{o.width} * o.height, draw, after);
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
  draw_all(what.size(), pixels, draw, [] {});
}

}  // namespace rastrum::python
