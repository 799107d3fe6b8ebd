#include "lit_ground.hpp"

#include <algorithm>
#include <optional>

namespace rastrum::cli {
namespace {

GroundLights ground_lights(const TerrainLook& options, const terrain::Light& light,
                           const FrameOptions& frame) {
  GroundLights ground;
  ground.lights = frame.lights;
  ground.shadows = light.shadows;
  ground.sun_radius_deg = light.sun_radius_deg;
  ground.march = light.march;
  ground.tone = frame.tone;
  ground.smooth = options.filter == terrain::MapFilter::bilinear;
  return ground;
}

}  // namespace

LitGround::LitGround(const LoadedTerrain& source, const TerrainLook& options,
                     const terrain::Light& light, const FrameOptions& frame,
                     const terrain::TerrainCamera& camera)
    : source_(source),
      options_(options),
      moves_(std::ranges::any_of(frame.lights, &Light::of_camera)),
      lights_(ground_lights(options, light, frame)),
      lit_(frame.lights.empty() ? source.lit(light, options) : source.lit(at(camera), options)) {}

const terrain::Terrain& LitGround::seen_from(const terrain::TerrainCamera& camera) {
  if (!moves_) return lit_;
  const std::optional<double> clearance = options_.classic ? 10 : options_.ground_clearance;
  const terrain::TerrainCamera stands =
      clearance ? terrain::above_ground(lit_, camera, *clearance, options_.tiling) : camera;
  if (stands != lights_.camera) lit_ = source_.lit(at(stands), options_);
  return lit_;
}

}  // namespace rastrum::cli
