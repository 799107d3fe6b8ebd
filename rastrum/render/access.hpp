// SPDX-License-Identifier: BSD-3-Clause
// Parts of a Renderer that are not for users: the pipeline's own draws, and other ways to draw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include <rastrum/parallel/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/drawer.hpp>
#include <rastrum/render/shadows.hpp>
#include <rastrum/stop.hpp>

namespace rastrum {

struct RendererAccess {
  /// A renderer whose frames are drawn by the drawer that `make` returns; with limited memory, by a
  /// new one for frames of another kind. `choice` replaces the options' device. `plain`: one thread
  /// without SIMD, whatever the device.
  [[nodiscard]] static Renderer make(RendererOptions options, DeviceChoice choice, bool plain,
                                     MakeFrameDrawer make);

  /// A pass may leave its translucent fragments to others, and all but a part of the picture; then
  /// targets need only that part (raster::placed). With a sink, passes that load may have
  /// translucent surfaces.
  struct Apart {
    raster::FragmentSink* sink = nullptr;
    std::optional<raster::Rect> part{};
    /// Made by shadows(); they replace those that `frame.shadows` asks for.
    std::span<const raster::LightShadow> shadows{};
  };
  static FrameStats render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                           const FrameOptions& frame, const Targets& targets, const Pass& pass,
                           const Apart& apart, StopToken stop = {});
  /// As raster::FrameDrawer::shade.
  static FrameStats shade(Renderer& renderer, const SceneView& scene, const Camera& camera,
                          const FrameOptions& frame, const Targets& targets, const Pass& pass,
                          const raster::KnownBlocks& known,
                          std::span<const raster::LightShadow> shadows);
  /// Calls draw(renderer of one thread, worker, i) for i in [0, count) side by side if pictures of
  /// so many `pixels` are small; no two calls at a time have the same worker, which is less than
  /// the number of threads. Otherwise calls nothing and returns false.
  [[nodiscard]] static bool draw_side_by_side(
      Renderer& renderer, std::size_t count, std::int64_t pixels,
      const std::function<void(Renderer& by, std::size_t worker, std::size_t i)>& draw,
      StopToken stop);
  /// The renderer's threads, for work on its pictures; null if it has none.
  [[nodiscard]] static parallel::Threads* threads(Renderer& renderer);

  /// The shadow maps of `frame`: the parts of all ranks as its lights see them. `scene` has this
  /// rank's parts. Valid until the renderer draws shadows again. All ranks must call this alike.
  static std::span<const raster::LightShadow> shadows(Renderer& renderer, const SceneView& scene,
                                                      const Camera& camera,
                                                      const FrameOptions& frame,
                                                      ShadowRanks& ranks);

  /// Draws with any vertex stage. A draw without functions of its own uses `shading` and `test`, so
  /// programs and built-in shaders meet in one frame. Outputs that a shader lacks are 0. Otherwise
  /// as Renderer::draw.
  static FrameStats draw(Renderer& renderer, std::span<raster::Draw> draws,
                         const raster::Shading& shading, const raster::Testing& test,
                         const FrameOptions& frame, const Targets& targets, const Pass& pass = {},
                         StopToken stop = {});
};

}  // namespace rastrum
