// SPDX-License-Identifier: BSD-3-Clause
// Sharp shadows by a sweep over the columns of a map, from the sun's side on; exact, O(1) per cell.
//
// Turn the map so that the sun lies towards larger X (the axis nearer to its azimuth) and rays are
// lines y = c + s·X, |s| ≤ 1. A ray that climbs `tau` per column is blocked by a cell of height h
// that it enters at X_e iff h − X_e·tau > (height where it begins) − (its X)·tau. The left side
// belongs to the cell alone, so a running maximum over columns, from the sun on, decides every cell
// of a line. But each cell's ray is a line of its own: c = row + φ(X), φ(X) = 1/2 − s·(X + 1/2),
// and φ differs in each column. So lines are grouped into bands, floor(c), and each band into
// kSubBands parts by the fraction of c, which all cells of a column share. For a part of a band the
// sweep holds two maxima: over the cells that any of its lines enters, at the earliest (an upper
// bound for rays), and over those that all of them enter, at the latest (a lower bound). Bands run
// along the sun's direction, so the bounds stay half a cell apart however far a shadow reaches. The
// traversal that defines the shadow decides the cells between the bounds, the edges of shadows. So
// the result is exact, however the sweep rounds.
//
// The sweep computes in 16-bit units, fractions of the relief. A unit is fine enough for any sun:
// the longest shadow of 65,536 cells lets rays climb at least about one unit per column, so cells
// that rounding leaves open are decided a few cells further. A block of columns counts from its
// begin, its frame: a height h that is met at X_e is h − (X_e − X of the block)·tau, and no sum
// leaves 16 bits. From one block to the next the bounds lose the climb of a ray on it, down to a
// least value.
//
// On axes and diagonals the rays of all cells run alike, and only rounding leaves cells between the
// bounds. Elsewhere 5 to 10 % of the cells of real maps lie there. The next columns decide most of
// these, in vectors; the rest skips blocks of columns by their upper bounds, a pyramid of one level
// along the ray. (A maximum pyramid over the map and a ray per cell would cost 20 to 40 nodes per
// cell, no less than the march of 256 samples in vectors.)
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/shadow_reach.hpp>

namespace rastrum::terrain {

inline constexpr int kSubBands = 2;
/// Columns of a block, which are copied, transposed and tiled before they are swept.
inline constexpr int kSweepBlock = 16;

/// h is round((h − lowest) · scale) + zero, off by at most half a unit and a few hundredths, by
/// which float32 rounds. Holes count as the lowest height, which never certainly hides the sun.
struct SweepUnits {
  static constexpr std::int16_t least = std::numeric_limits<std::int16_t>::min();
  float lowest = 0, scale = 0;
  std::int16_t zero = 0;  ///< of the lowest height; no subtraction in a block overflows
};

/// One operation on a cell of a column, the same for all bands.
struct SweepStep {
  enum class Kind : std::uint8_t {
    may_enter,   ///< some rays of the part may enter it: raises the upper bound
    all_enter,   ///< all enter it: raises both bounds
    cells_begin  ///< begins of the column's own rays in this part: decides their cells
  };
  Kind kind;
  std::uint8_t column;  ///< of the block
  std::int32_t row;     ///< of band 0's cell, counted from the first band's number
  /// Subtracted from the cell's height. An entered cell: for the upper and the lower bound. A
  /// begin: for the sum above which an upper bound may hide the sun, and a lower bound certainly
  /// does.
  std::int16_t upper, lower;
};

struct SweepColumn {
  std::int32_t begin_row = 0;  ///< of the cell whose ray is in band 0
  std::int32_t part = 0;       ///< of the band, with the rays of this column's cells
  std::int64_t begin = 0;      ///< (X + 1/2)·tau in units, rounded down
};

struct SweepBlock {
  std::int64_t frame = 0;          ///< X·tau of its first column in units, rounded down
  std::int32_t low = 0, high = 0;  ///< of the rows of its steps
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
  std::vector<SweepRayStep> near;         ///< the same steps on the next two blocks
  std::vector<std::uint32_t> first_step;  ///< [n]: the first step of the ray n columns ahead
  bool along_x = true;                    ///< X runs along the map's x; else along its y
  bool flipped = false;                   ///< X runs against that axis
  int columns = 0;                        ///< of the map along X
  int rows = 0;                           ///< across X
  int first_band = 0, bands = 0;
  bool cyclic = false;  ///< rows repeat: band b is band b + rows
  std::vector<SweepStep> steps;
  std::vector<SweepBlock> blocks;  ///< the map's, then those beyond it that cast shadows on it
  std::vector<int> reach;          ///< in blocks, for each kReachBands bands
  std::vector<SweepColumn> column;

  /// The first step at least `ahead` columns from where the ray begins.
  [[nodiscard]] std::size_t step_at(int ahead) const {
    const auto last = static_cast<int>(first_step.size()) - 1;
    return first_step[static_cast<std::size_t>(ahead < 0 ? 0 : ahead < last ? ahead : last)];
  }
};

/// Whether float32 has units for a map's heights and their differences. Almost all maps pass.
[[nodiscard]] inline bool can_sweep(const ShadowCaster& map) {
  return map.relief() > 0x1p-100 && map.relief() < 0x1p126;
}

/// Requires the steps of `ray`, the map's tiles and can_sweep(map).
[[nodiscard]] Sweep plan_sweep(const ShadowCaster& map, const HeightTiles& tiles, const SunRay& ray,
                               std::vector<RayStep> steps);

}  // namespace rastrum::terrain
