// SPDX-License-Identifier: BSD-3-Clause
// Renderers with all options of a picture in one object, as tests vary them.
#pragma once

#include <span>
#include <stop_token>
#include <utility>

#include <rastrum/family.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum::test {

/// The options of the renderer, the family's row and the frames.
struct RenderOptions : family::Options {
  bool in_place = false;  ///< frames by Renderer::render_in_place

  RenderOptions(FrameOptions frame = {}, RendererOptions how = {}, family::Row row = {})
      : family::Options{std::move(how), std::move(frame), std::move(row)} {}
};

/// Throws the errors of both parts of the options.
class Painter {
 public:
  explicit Painter(const RenderOptions& options)
      : options_((check(options), options)), renderer_(family::make_renderer(options, options)) {
    options_.device = renderer_.options().device;
  }

  FrameStats render(const SceneView& scene, const Camera& camera, const Targets& targets,
                    const Pass& pass = {}, std::stop_token stop = {}) {
    return options_.in_place ? renderer_.render_in_place(scene, camera, options_, targets, stop)
                             : renderer_.render(scene, camera, options_, targets, pass, stop);
  }
  /// Draws with the draws' own shaders and tests, or with these.
  FrameStats draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                  const raster::Testing& test, const Targets& targets, const Pass& pass = {},
                  std::stop_token stop = {}) {
    return RendererAccess::draw(renderer_, draws, shading, test, options_, targets, pass, stop);
  }
  FrameStats draw(std::span<raster::Draw> draws, const Targets& targets, const Pass& pass = {}) {
    return RendererAccess::draw(renderer_, draws, {}, {}, options_, targets, pass);
  }

  /// The options, with Device::automatic resolved.
  [[nodiscard]] const RenderOptions& options() const { return options_; }

 private:
  RenderOptions options_;
  Renderer renderer_;
};

/// One frame with everything chosen by `options`.
[[nodiscard]] inline Image<Rgba8> render(const SceneView& scene, const Camera& camera,
                                         const RenderOptions& options) {
  Image<Rgba8> image(options.width, options.height);
  Painter(options).render(scene, camera, {.color8 = image});
  return image;
}

/// The same of terrains.
struct TerrainLook : terrain::TerrainOptions, terrain::TerrainRendererOptions {
  TerrainLook(terrain::TerrainOptions look = {}, terrain::TerrainRendererOptions how = {})
      : terrain::TerrainOptions(std::move(look)), terrain::TerrainRendererOptions(how) {}
};

class TerrainPainter {
 public:
  explicit TerrainPainter(const TerrainLook& look)
      : look_((terrain::check(look), look)), renderer_(look) {
    look_.device = renderer_.options().device;
  }
  terrain::TerrainStats render(const terrain::Terrain& terrain,
                               const terrain::TerrainCamera& camera,
                               const terrain::TerrainTargets& targets, std::stop_token stop = {}) {
    return renderer_.render(terrain, camera, look_, targets, stop);
  }
  [[nodiscard]] const TerrainLook& options() const { return look_; }

 private:
  TerrainLook look_;
  terrain::TerrainRenderer renderer_;
};

}  // namespace rastrum::test
