// A terrain in its light, for the program's pictures and the window's: lit again where lights move
// with the camera.
#pragma once

#include <rastrum/frame.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "terrain_input.hpp"

namespace rastrum::cli {

class LitGround {
 public:
  /// By the lights of `frame`, with the shadows of `light`; without any by `light`, a sun. `source`
  /// must outlive it. `camera`: who looks first.
  LitGround(const LoadedTerrain& source, const TerrainLook& options, const terrain::Light& light,
            const FrameOptions& frame, const terrain::TerrainCamera& camera);

  [[nodiscard]] const terrain::Terrain& terrain() const { return lit_; }
  /// As `camera` sees it.
  const terrain::Terrain& seen_from(const terrain::TerrainCamera& camera);

 private:
  const GroundLights& at(const terrain::TerrainCamera& camera) {
    lights_.camera = camera;
    return lights_;
  }

  const LoadedTerrain& source_;
  TerrainLook options_;
  bool moves_;
  GroundLights lights_;
  terrain::Terrain lit_;
};

}  // namespace rastrum::cli
