// The samples of a frame, whatever the terrain is made of: heights for a run of slices of a column
// or of columns of a slice, colours one at a time.
#pragma once

#include <cstddef>

#include <rastrum/terrain/ceiling.hpp>
#include <rastrum/terrain/map_view.hpp>
#include <rastrum/terrain/setup.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

struct Samples {
  const Setup& setup;
  const Terrain& terrain;
  MapView map;                       ///< where the terrain is one
  const Ceiling* ceiling = nullptr;  ///< of the map, for methods that leave out what is hidden

  [[nodiscard]] float offset_x(std::size_t column, const Slice& slice) const {
    return setup.fx + slice.z * setup.ux[column];
  }
  [[nodiscard]] float offset_y(std::size_t column, const Slice& slice) const {
    return setup.fy + slice.z * setup.uy[column];
  }
  [[nodiscard]] float height(std::size_t column, const Slice& slice) const {
    const float x = offset_x(column, slice), y = offset_y(column, slice);
    if (terrain.is_map()) return map.height_at(x, y, slice.level);
    const double px = setup.camera_x + static_cast<double>(x);
    const double py = setup.camera_y + static_cast<double>(y);
    float height = 0;
    terrain.surface().heights(&px, &py, 1, &height);
    return height;
  }
  /// As it is seen: opaque, behind the fog.
  [[nodiscard]] Rgba8 color(std::size_t column, const Slice& slice) const {
    const float x = offset_x(column, slice), y = offset_y(column, slice);
    Rgba8 color;
    if (terrain.is_map()) {
      color = map.color_at(x, y, slice.level);
    } else {
      const double px = setup.camera_x + static_cast<double>(x);
      const double py = setup.camera_y + static_cast<double>(y);
      terrain.surface().colors(&px, &py, 1, &color);
    }
    return faded(color, setup.fog, slice.clear);
  }
  /// The row of a height, counted from the top; NaN in a hole. Its floor is the first row that is
  /// drawn.
  [[nodiscard]] float row(float height, const Slice& slice) const {
    return (setup.altitude - height) * slice.rows + setup.horizon;
  }
};

}  // namespace rastrum::terrain
