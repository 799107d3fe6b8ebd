// SPDX-License-Identifier: BSD-3-Clause
// Sharp shadows by a sweep over the columns of a map, from the sun's side on; exact, O(1) a cell.
//
// Turn the map so that the sun lies towards larger X (the axis nearer to its azimuth) and rays are
// lines y = c + s·X, |s| ≤ 1. A ray that climbs `tau` a column is blocked by a cell of height h
// that it enters at X_e iff h − X_e·tau > (height where it begins) − (its X)·tau: the left side
// belongs to the cell alone, so a running maximum over columns, from the sun on, decides every cell
// of a line. But each cell's ray is a line of its own: c = row + φ(X), φ(X) = 1/2 − s·(X + 1/2),
// and φ is different in each column. So lines are taken together in bands, floor(c), and each band
// in kSubBands parts by the fraction of c, which is the same for all cells of a column. For a part
// of a band the sweep holds two maxima: over the cells that any of its lines enters, at the
// earliest (an upper bound for rays), and over those that all of them enter, at the latest (a lower
// bound). Bands run along the sun's direction, so the bounds stay half a cell apart however far a
// shadow reaches. The traversal that defines the shadow decides cells between the bounds, which are
// the edges of shadows. So the result is exact, however the sweep rounds.
//
// The sweep computes in whole units of a part of the relief, in 16 bits. A unit is not too coarse
// for any sun: the longest shadow of 65,536 cells lets rays climb at least about one a column, so
// cells that rounding leaves open are decided a few cells further. Columns come in blocks, and
// within a block all is relative to its begin, its frame: a height h that is met at X_e counts as h
// − (X_e − X of the block)·tau, and no sum leaves 16 bits. From a block to the next the bounds lose
// the climb of a ray on it, down to a value that nothing is below. shadow_reach.hpp tells how many
// blocks there are beyond the map.
//
// On axes and diagonals, rays of all cells run alike, and only rounding leaves cells between the
// bounds; elsewhere 5 to 10 % of the cells of real maps lie there. The next columns decide most of
// these, in vectors; the rest skips blocks of columns by their upper bounds, a pyramid of one level
// along the ray. (A maximum pyramid over the map and a ray for each cell would cost 20 to 40 nodes
// a cell, which is no less than the march of 256 samples in vectors.)
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/shadow_reach.hpp>

namespace rastrum::terrain {

inline constexpr int kSubBands = 2;
/// Columns of a block. A block's cells are copied, turned and tiled before they are swept.
inline constexpr int kSweepBlock = 16;

/// Heights in units of the sweep: h is round((h − lowest) · scale) + zero, off by at most half a
/// unit and a few hundredths, by which float32 rounds. Holes are as high as the lowest height,
/// which never surely hides the sun from another.
struct SweepUnits {
  static constexpr std::int16_t least = std::numeric_limits<std::int16_t>::min();
  float lowest = 0, scale = 0;
  std::int16_t zero = 0;  ///< of the lowest height: nothing subtracted in a block overflows
};

/// One operation on a cell of a column, the same for all bands.
struct SweepStep {
  enum class Kind : std::uint8_t {
    may_enter,   ///< rays of the part may enter it: raises the upper bound
    all_enter,   ///< all do: raises both
    cells_begin  ///< the column's own cells, whose rays lie in this part: they are judged
  };
  Kind kind;
  std::uint8_t column;  ///< of the block
  std::int32_t row;     ///< of band 0's cell, from the first band's number
  /// Subtracted from the cell's height. Where rays enter it: for the upper and the lower bound.
  /// Where rays begin: for the sum that upper bounds must exceed to hide the sun perhaps, and for
  /// the one that lower bounds must exceed to hide it surely.
  std::int16_t upper, lower;
};

struct SweepColumn {
  std::int32_t begin_row = 0;  ///< the cell whose ray is in band 0 lies in this row
  std::int32_t part = 0;       ///< of the band, in which rays of this column's cells lie
  std::int64_t begin = 0;      ///< (X + 1/2)·tau in units, rounded down
};

struct SweepBlock {
  std::int64_t frame = 0;          ///< X·tau of its first column in units, rounded down
  std::int32_t low = 0, high = 0;  ///< the least and greatest of all rows below
  /// Part p has [first[p], first[p + 1]) of Sweep::steps, the farthest column's first.
  std::array<std::uint32_t, kSubBands + 1> first{};
};

/// A RayStep in the sweep's axes and units.
struct SweepRayStep {
  std::int32_t ahead = 0, across = 0;  ///< columns, rows
  std::int32_t climb = 0;              ///< in units, rounded down
};

struct Sweep {
  ShadowCaster map;
  SweepUnits units;
  std::vector<RayStep> ray;
  std::vector<SweepRayStep> near;         ///< the same, on two blocks
  std::vector<std::uint32_t> first_step;  ///< of the ray, that lies this many columns ahead
  bool along_x = true;                    ///< X runs along the map's x; else along its y
  bool flipped = false;                   ///< against it
  int columns = 0;                        ///< of the map along X
  int rows = 0;                           ///< across
  int first_band = 0, bands = 0;
  bool cyclic = false;  ///< rows repeat, and band b is band b + rows
  std::vector<SweepStep> steps;
  std::vector<SweepBlock> blocks;  ///< the map's, then those beyond that cast shadows on it
  std::vector<int> reach;          ///< of these, for each kReachBands bands
  std::vector<SweepColumn> column;

  /// The first step at least `ahead` columns from where the ray begins.
  [[nodiscard]] std::size_t step_at(int ahead) const {
    const auto last = static_cast<int>(first_step.size()) - 1;
    return first_step[static_cast<std::size_t>(ahead < 0 ? 0 : ahead < last ? ahead : last)];
  }
};

/// Whether float32 has units for a map and for differences of its heights; almost all maps pass.
[[nodiscard]] inline bool can_sweep(const ShadowCaster& map) {
  return map.relief() > 0x1p-100 && map.relief() < 0x1p126;
}

/// Requires the steps of `ray`, the map's tiles and a map for which can_sweep is true.
[[nodiscard]] Sweep plan_sweep(const ShadowCaster& map, const HeightTiles& tiles, const SunRay& ray,
                               std::vector<RayStep> steps);

}  // namespace rastrum::terrain
