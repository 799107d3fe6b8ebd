// What of a Renderer is not for its users: frames of the pipeline's own draws, and renderers that
// draw in another way.
#pragma once

#include <optional>
#include <span>
#include <stop_token>

#include <rastrum/parallel/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/drawer.hpp>
#include <rastrum/render/shadows.hpp>

namespace rastrum {

struct RendererAccess {
  /// A renderer whose frames are drawn by what `make` makes, again where memory is limited and
  /// frames are of another kind. `choice`: the device, which the
  /// options' became; `plain`: on one thread without SIMD, whatever the device.
  [[nodiscard]] static Renderer make(RendererOptions options, DeviceChoice choice, bool plain,
                                     MakeFrameDrawer make);

  /// What a pass of a scene may leave to others: its translucent fragments, and all but a part of
  /// the picture, which `targets` hold then (FrameRequest::part). Passes that load may be of scenes
  /// with translucent surfaces then.
  struct Apart {
    raster::FragmentSink* sink = nullptr;
    std::optional<raster::Rect> part{};
    const raster::KnownBlocks* known = nullptr;  ///< FrameRequest::known
    /// Of lights, in the place of those that `frame.shadows` asks for; shadows() has made them.
    std::span<const raster::LightShadow> shadows{};
  };
  static FrameStats render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                           const FrameOptions& frame, const Targets& targets, const Apart& apart,
                           std::stop_token stop = {});
  /// Its threads, for work on what it has drawn; null where it has none.
  [[nodiscard]] static parallel::Threads* threads(Renderer& renderer);

  /// What the lights of `frame` see of the parts of all ranks, of this one's `scene` among them;
  /// for the passes of one frame. All ranks call it alike; the result lives until the renderer
  /// draws shadows again.
  static std::span<const raster::LightShadow> shadows(Renderer& renderer, const SceneView& scene,
                                                      const Camera& camera,
                                                      const FrameOptions& frame,
                                                      ShadowRanks& ranks);

  /// Draws of any vertex stage, each shaded and tested by its own functions or, where it has none,
  /// by `shading` and `test`. So programs and built-in shaders meet in one frame;
  /// outputs that a draw's shader does not have are 0. Otherwise as Renderer::draw.
  static FrameStats draw(Renderer& renderer, std::span<raster::Draw> draws,
                         const raster::Shading& shading, const raster::Testing& test,
                         const FrameOptions& frame, const Targets& targets,
                         std::stop_token stop = {});
};

}  // namespace rastrum
