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
#include "scenes.hpp"

namespace rastrum::python {

/// The scenes of several pictures.
struct ManyShown {
  std::vector<ArrayScene::Shown> scenes{};  ///< one for each picture, or one for all
  /// (pictures, things, 4, 4): places of the only scene's things in each picture; or empty.
  std::span<const double> transforms{};

  /// The scene of a picture. `instances`: memory for it.
  [[nodiscard]] SceneView of(std::size_t picture, std::vector<InstanceView>& instances) const;
};

class FrameRenderer {
 public:
  explicit FrameRenderer(const RendererOptions& options);

  /// A picture per camera. Calls after(n) after n more are drawn: one, or all that are drawn side
  /// by side.
  std::vector<FrameStats> render(const ManyShown& shown, const std::vector<Camera>& cameras,
                                 const FrameOptions& o, const std::vector<Wanted>& outputs,
                                 const Annotations* annotations, StopToken stop,
                                 const std::function<void(std::size_t)>& after);
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
  /// Small pictures side by side, a thread each; others one after the other by all threads.
  void draw_all(std::size_t pictures, std::int64_t pixels,
                const std::function<void(Renderer& by, Scratch& scratch, std::size_t i)>& draw,
                StopToken stop, const std::function<void(std::size_t)>& after);

  std::mutex mutex_{};
  Renderer renderer_;
  Scratch scratch_;
  std::vector<std::unique_ptr<Scratch>> of_workers_;  ///< by worker of pictures side by side
};

}  // namespace rastrum::python
