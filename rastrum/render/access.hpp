// SPDX-License-Identifier: BSD-3-Clause
// The parts of a Renderer that are not for its users: frames of the pipeline's own draws, and
// renderers that draw in another way.
#pragma once

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
  /// A renderer whose frames are drawn by the drawer that `make` returns. If memory is limited, it
  /// makes a new one when frames of another kind come. `choice`: the device, which replaces that of
  /// the options; `plain`: on one thread without SIMD, whatever the device.
  [[nodiscard]] static Renderer make(RendererOptions options, DeviceChoice choice, bool plain,
                                     MakeFrameDrawer make);

  /// A pass of a scene may leave work to others: its translucent fragments, and all but a part of
  /// the picture, in which case targets need hold no more (raster::placed). With a sink, passes
  /// that load may have translucent surfaces.
  struct Apart {
    raster::FragmentSink* sink = nullptr;
    std::optional<raster::Rect> part{};
    /// Shadows made by shadows(), instead of those that `frame.shadows` asks for.
    std::span<const raster::LightShadow> shadows{};
  };
  static FrameStats render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                           const FrameOptions& frame, const Targets& targets, const Pass& pass,
                           const Apart& apart, StopToken stop = {});
  /// As raster::FrameDrawer has it.
  static FrameStats shade(Renderer& renderer, const SceneView& scene, const Camera& camera,
                          const FrameOptions& frame, const Targets& targets, const Pass& pass,
                          const raster::KnownBlocks& known,
                          std::span<const raster::LightShadow> shadows);
  /// The renderer's threads, for work on what it has drawn; null if it has none.
  [[nodiscard]] static parallel::Threads* threads(Renderer& renderer);

  /// Draws the parts of all ranks as the lights of `frame` see them; `scene` has this rank's parts.
  /// The result is for the passes of one frame: it lives until the renderer draws shadows again.
  /// All ranks must call this alike.
  static std::span<const raster::LightShadow> shadows(Renderer& renderer, const SceneView& scene,
                                                      const Camera& camera,
                                                      const FrameOptions& frame,
                                                      ShadowRanks& ranks);

  /// Draws with any vertex stage. Each is shaded and tested by its own functions or, if it has
  /// none, by `shading` and `test`, so programs and built-in shaders meet in one frame. Outputs
  /// that a draw's shader does not have are 0. Otherwise as Renderer::draw.
  static FrameStats draw(Renderer& renderer, std::span<raster::Draw> draws,
                         const raster::Shading& shading, const raster::Testing& test,
                         const FrameOptions& frame, const Targets& targets, const Pass& pass = {},
                         StopToken stop = {});
};

}  // namespace rastrum
