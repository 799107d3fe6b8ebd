// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/terrain/cell.hpp>

namespace rastrum::terrain {
namespace {

/// Grey from the lowest height to the highest.
Image<Rgba8> grey_of(const Image<float>& heights, float highest) {
  float lowest = std::numeric_limits<float>::infinity();
  for (const float h : heights.pixels())
    if (h < lowest) lowest = h;
  Image<Rgba8> grey(heights.width(), heights.height());
  const float scale = highest > lowest ? 255 / (highest - lowest) : 0;
  for (std::size_t i = 0; i < grey.pixels().size(); ++i) {
    const float g = (heights.pixels()[i] - lowest) * scale;
    const auto value = static_cast<std::uint8_t>(g > 0 ? std::min(g, 255.0F) : 0.0F);
    grey.pixels()[i] = {value, value, value, 255};
  }
  return grey;
}

}  // namespace

Terrain::Terrain(HeightMap map) : highest_(-std::numeric_limits<float>::infinity()) {
  const FloatScope floats;
  if (map.heights.empty()) reject("the height map has no cell; give it at least one");
  for (const float h : map.heights.pixels())
    if (h > highest_) highest_ = h;
  if (map.colors.empty()) map.colors = grey_of(map.heights, highest_);
  heights_ = std::make_unique<const Image<float>>(std::move(map.heights));
  colors_ = std::make_unique<const Image<Rgba8>>(std::move(map.colors));
}

Terrain::Terrain(Shared<const Surface> surface)
    : surface_(std::move(surface)), highest_(std::numeric_limits<float>::infinity()) {
  const FloatScope floats;
  if (surface_ == nullptr) reject("the terrain has no surface");
}

Terrain Terrain::with_colors(Image<Rgba8> colors) const {
  if (!is_map()) reject("a terrain of functions has its own colours");
  if (colors.empty()) reject("the colours of a terrain are empty");
  Terrain other = *this;
  other.colors_ = std::make_unique<const Image<Rgba8>>(std::move(colors));
  return other;
}

const Surface& Terrain::surface() const {
  if (is_map()) reject("a terrain that is a map has no surface");
  return *surface_;
}

float Terrain::height_at(double x, double y, Tiling tiling) const {
  if (!is_map()) {
    float height = 0;
    surface_->heights(&x, &y, 1, &height);
    return height;
  }
  if (tiling == Tiling::none &&
      !(x >= 0 && x < heights_->width() && y >= 0 && y < heights_->height()))
    return std::numeric_limits<float>::quiet_NaN();
  return (*heights_)(static_cast<int>(cell_at(x, heights_->width(), tiling)),
                     static_cast<int>(cell_at(y, heights_->height(), tiling)));
}

Rgba8 Terrain::color_at(double x, double y, Tiling tiling) const {
  if (!is_map()) {
    Rgba8 color;
    surface_->colors(&x, &y, 1, &color);
    return color;
  }
  return (*colors_)(texel_at(x, heights_->width(), colors_->width(), tiling),
                    texel_at(y, heights_->height(), colors_->height(), tiling));
}

double ground_at(const Terrain& terrain, double x, double y, const TerrainOptions& options) {
  const FloatScope floats;
  const auto here = static_cast<double>(terrain.height_at(x, y, options.tiling));
  if (!terrain.is_map() || options.filter != MapFilter::bilinear || std::isnan(here)) return here;
  const Tiling tiling = options.tiling == Tiling::none ? Tiling::clamp : options.tiling;
  const auto at = [&](double u, double v) {
    return static_cast<double>(terrain.height_at(u, v, tiling));
  };
  const double u = std::floor(x - 0.5), v = std::floor(y - 0.5);
  const double tx = x - 0.5 - u, ty = y - 0.5 - v;
  const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
  return mix(mix(at(u, v), at(u + 1, v), tx), mix(at(u, v + 1), at(u + 1, v + 1), tx), ty);
}

TerrainCamera above_ground(const Terrain& terrain, const TerrainCamera& camera, double clearance,
                           Tiling tiling) {
  const FloatScope floats;
  TerrainCamera lifted = camera;
  const double ground = terrain.height_at(camera.x, camera.y, tiling);
  if (ground + clearance > camera.altitude) lifted.altitude = ground + clearance;
  return lifted;
}

}  // namespace rastrum::terrain
