// What a frame's samples have in common: the direction of each column and the distance of each
// slice. Every method but `classic` takes its samples from here, so they agree bit for bit.
//
// The sample of column i on slice k lies at offset (fx + z·ux, fy + z·uy) from the corner of the
// camera's cell, float32: an error of 2⁻²³ of the distance, far less than a column's width,
// wherever on the map the camera is; the cell itself is an integer. Its row is (altitude − height)
// · rows + horizon. Multiply and add are kept apart.
#pragma once

#include <cstdint>
#include <vector>

#include <rastrum/terrain/options.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

/// All columns are sampled at distance z.
struct Slice {
  float z = 1;
  float rows = 1;    ///< that a height of 1 takes there
  float lowest_row;  ///< no sample from here on lies above this row; it only shortens the work
  std::int32_t level = 0;     ///< of the pyramid: cells of 2^level
  std::uint32_t clear = 256;  ///< of 256: what the fog leaves of a colour
};

struct Setup {
  std::vector<float> ux, uy;            ///< of each column: cells per cell of distance
  std::vector<Slice> slices;            ///< near to far
  double camera_x = 0, camera_y = 0;    ///< corner of the camera's cell
  std::int32_t cell_x = 0, cell_y = 0;  ///< the same within a map's period (or beyond its edge)
  float fx = 0, fy = 0;                 ///< of the camera in its cell, [0, 1)
  float altitude = 0;
  float horizon = 0;  ///< rows, with the half row that makes floor(row) the first centre below
  int height = 0;     ///< of the picture
  Rgba8 sky, fog;
};

/// Throws Error{invalid_argument} that names the option out of range.
void check(const TerrainOptions& options);
/// Throws Error{invalid_argument} where it is not finite or too far away.
void check(const TerrainCamera& camera);

/// Rows that a height of 1 takes at distance 1.
[[nodiscard]] double scale_px(const TerrainOptions& options);

/// Requires checked options and camera. O(width + slices).
[[nodiscard]] Setup set_up(const TerrainOptions& options, const TerrainCamera& camera,
                           const Terrain& terrain);

}  // namespace rastrum::terrain
