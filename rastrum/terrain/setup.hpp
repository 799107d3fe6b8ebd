// SPDX-License-Identifier: BSD-3-Clause
// The directions of a frame's columns and the distances of its slices. Every method but `classic`
// takes its samples from here, so they agree bit for bit.
//
// The sample of column i on slice k lies at offset (fx + z·ux, fy + z·uy) in float32 from the
// corner of the camera's cell, an integer. The error is 2⁻²³ of the distance wherever the camera
// is, far less than a column's width. The sample's row is (altitude − height) · rows + horizon.
// Multiply and add are not fused.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <rastrum/terrain.hpp>

namespace rastrum::terrain {

/// A distance z at which all columns are sampled.
struct Slice {
  float z = 1;
  float rows = 1;             ///< of a height of 1 at this distance
  float lowest_row;           ///< no later sample rises above this row; it only saves work
  std::int32_t level = 0;     ///< of the pyramid: cells of 2^level
  std::uint32_t clear = 256;  ///< of 256: the share of a colour that the fog leaves
};

struct SharedSetup {
  double camera_x = 0, camera_y = 0;    ///< corner of the camera's cell
  std::int32_t cell_x = 0, cell_y = 0;  ///< the same within a map's period (or beyond its edge)
  float fx = 0, fy = 0;                 ///< the camera in its cell, [0, 1)
  float altitude = 0;
  float horizon = 0;  ///< plus the half row that makes floor(row) the first centre below
  int height = 0;     ///< of the picture
  Rgba8 sky, fog;
};

struct Setup : SharedSetup {
  std::vector<float> ux, uy;  ///< of each column: cells per cell of distance
  std::vector<Slice> slices;  ///< near to far
};

/// Filtering may round up a little.
[[nodiscard]] RASTRUM_HD inline float filtered_bound(float highest) {
  return highest + std::abs(highest) * 0x1p-20F;
}

/// The first row of a sample that is not drawn.
inline constexpr std::int32_t kNoRow = std::numeric_limits<std::int32_t>::max();

/// A Setup by value, with its lists in the device's memory.
struct SetupView : SharedSetup {
  std::span<const float> ux, uy;
  std::span<const Slice> slices;

  SetupView(const Setup& s) : SetupView(s, s.ux, s.uy, s.slices) {}
  SetupView(const SharedSetup& shared, std::span<const float> across, std::span<const float> down,
            std::span<const Slice> along)
      : SharedSetup(shared), ux(across), uy(down), slices(along) {}

  [[nodiscard]] RASTRUM_HD float offset_x(std::size_t column, const Slice& slice) const {
    return fx + slice.z * ux[column];
  }
  [[nodiscard]] RASTRUM_HD float offset_y(std::size_t column, const Slice& slice) const {
    return fy + slice.z * uy[column];
  }
  /// Counted from the top; NaN in a hole. Its floor is the first row drawn.
  [[nodiscard]] RASTRUM_HD float row(float ground, const Slice& slice) const {
    return (altitude - ground) * slice.rows + horizon;
  }
  [[nodiscard]] RASTRUM_HD std::int32_t first_row(float ground, const Slice& slice) const {
    const float at = row(ground, slice);
    if (!(at < static_cast<float>(height))) return kNoRow;  // also NaN
    return at > 0 ? static_cast<std::int32_t>(at) : 0;
  }
};

inline constexpr double kMaxSlices = 0x1p24;

/// Throws Error{invalid_argument} that names the option out of range.
void check(const TerrainOptions& options);
/// Throws Error{invalid_argument} if it is not finite or too far away.
void check(const TerrainCamera& camera);

/// Slices before `distance`. For `classic` rounding may change it by a few.
[[nodiscard]] double slice_count(const TerrainOptions& options);

/// Rows of a height of 1 at distance 1.
[[nodiscard]] double scale_px(const TerrainOptions& options);

struct Extent {
  int width = 0, height = 0;  ///< cells of a map; 0 for functions
  float highest = std::numeric_limits<float>::infinity();
};
[[nodiscard]] Extent extent_of(const Terrain& terrain);

/// Requires checked options and camera. O(width + slices).
[[nodiscard]] Setup set_up(const TerrainOptions& options, const TerrainCamera& camera,
                           const Extent& terrain);
[[nodiscard]] inline Setup set_up(const TerrainOptions& options, const TerrainCamera& camera,
                                  const Terrain& terrain) {
  return set_up(options, camera, extent_of(terrain));
}

}  // namespace rastrum::terrain
