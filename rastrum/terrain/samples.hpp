// SPDX-License-Identifier: BSD-3-Clause
// The samples of a frame, with heights and colours one at a time.
#pragma once

#include <cstddef>

#include <rastrum/terrain.hpp>
#include <rastrum/terrain/ceiling.hpp>
#include <rastrum/terrain/map_view.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {

struct MapSamples {
  SetupView setup;
  MapView map;

  [[nodiscard]] RASTRUM_HD float height(std::size_t column, const Slice& slice) const {
    return map.height_at(setup.offset_x(column, slice), setup.offset_y(column, slice), slice.level);
  }
  /// Opaque, with fog.
  [[nodiscard]] RASTRUM_HD Rgba8 color(std::size_t column, const Slice& slice) const {
    return faded(
        map.color_at(setup.offset_x(column, slice), setup.offset_y(column, slice), slice.level),
        setup.fog, slice.clear);
  }
};

/// The samples of any terrain, on the CPU.
struct Samples : MapSamples {
  const Terrain& terrain;
  const Ceiling* ceiling = nullptr;  ///< of the map, for methods that skip hidden samples

  [[nodiscard]] float height(std::size_t column, const Slice& slice) const {
    if (terrain.is_map()) return MapSamples::height(column, slice);
    const double px = setup.camera_x + static_cast<double>(setup.offset_x(column, slice));
    const double py = setup.camera_y + static_cast<double>(setup.offset_y(column, slice));
    float height = 0;
    terrain.surface().heights(&px, &py, 1, &height);
    return height;
  }
  /// Opaque, with fog.
  [[nodiscard]] Rgba8 color(std::size_t column, const Slice& slice) const {
    if (terrain.is_map()) return MapSamples::color(column, slice);
    const double px = setup.camera_x + static_cast<double>(setup.offset_x(column, slice));
    const double py = setup.camera_y + static_cast<double>(setup.offset_y(column, slice));
    Rgba8 color;
    terrain.surface().colors(&px, &py, 1, &color);
    return faded(color, setup.fog, slice.clear);
  }
};

}  // namespace rastrum::terrain
