// What of a Renderer is not for its users: frames of the pipeline's own draws, and renderers that
// draw in another way.
#pragma once

#include <span>
#include <stop_token>

#include <rastrum/parallel/device.hpp>
#include <rastrum/render.hpp>
#include <rastrum/render/drawer.hpp>

namespace rastrum {

struct RendererAccess {
  /// A renderer whose frames are drawn by what `make` makes, again where memory is limited and
  /// frames are of another kind. `choice`: the device, which the
  /// options' became; `plain`: on one thread without SIMD, whatever the device.
  [[nodiscard]] static Renderer make(RendererOptions options, DeviceChoice choice, bool plain,
                                     MakeFrameDrawer make);

  /// Draws of any vertex stage, each shaded and tested by its own functions or, where it has none,
  /// by `shading` and `test`. So programs and built-in shaders meet in one frame;
  /// outputs that a draw's shader does not have are 0. Otherwise as Renderer::draw.
  static FrameStats draw(Renderer& renderer, std::span<raster::Draw> draws,
                         const raster::Shading& shading, const raster::Testing& test,
                         const FrameOptions& frame, const Targets& targets,
                         std::stop_token stop = {});
};

}  // namespace rastrum
