// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/render.hpp>

#include "outputs.hpp"
#include "rasterize.hpp"

namespace rastrum::python {

class FrameRenderer {
 public:
  explicit FrameRenderer(const RendererOptions& options)
      : options_(options), renderer_(options), scratch_(options) {}

  /// A picture per camera. `after`: called after each that is drawn alone, once after all that are
  /// drawn side by side.
  std::vector<FrameStats> render(const SceneView& scene, const std::vector<Camera>& cameras,
                                 const FrameOptions& o, const std::vector<Wanted>& outputs,
                                 const Annotations* annotations, StopToken stop,
                                 const std::function<void()>& after);
  std::optional<Pick> pick(const SceneView& scene, const Camera& camera, const FrameOptions& o,
                           int x, int y) {
    return renderer_.pick(scene, camera, o, x, y);
  }
  /// For frames of ranks, which take several passes. Only one thread may use it at a time.
  [[nodiscard]] Renderer& alone() { return renderer_; }
  [[nodiscard]] Annotator& annotator() { return scratch_.annotator; }
  /// A picture for each of `what`, one behind the other.
  void rasterize(std::span<const ClipTriangles> what, ImageView<Vec4> first, StopToken stop);

 private:
  using Draw = std::function<void(Renderer& by, Scratch& scratch, std::size_t i)>;
  /// Small pictures side by side, a thread each; others one after the other by all threads.
  void draw_all(std::size_t pictures, std::int64_t pixels, const Draw& draw,
                const std::function<void()>& after);
  void draw_side_by_side(std::size_t pictures, std::size_t workers, const Draw& draw);

  struct Side {
    explicit Side(const RendererOptions& options) : renderer(options), scratch(options) {}
    Renderer renderer;
    Scratch scratch;
  };
  RendererOptions options_;
  std::mutex mutex_{};
  Renderer renderer_;
  Scratch scratch_;
  std::vector<std::unique_ptr<Side>> side_{};
};

}  // namespace rastrum::python
