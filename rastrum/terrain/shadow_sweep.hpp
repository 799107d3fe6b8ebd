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
// earliest (an upper bound of what a ray meets), and over those that all of them enter, at the
// latest (a lower bound). Bands run along the sun's direction, so the bounds stay half a cell apart
// however far a shadow reaches. What lies between them, the edges of shadows, is decided by the
// traversal that defines the shadow; so the result is exact, whatever the sweep rounds to.
//
// On axes and diagonals, rays of all cells run alike and nothing lies between the bounds; elsewhere
// 5 to 10 % of the cells of real maps do. Most of these are decided in vectors by the next columns,
// and the rest skips blocks of columns by their upper bounds, a pyramid of one level along the ray.
// (A maximum pyramid over the map and a ray for each cell would cost 20 to 40 nodes a cell, which
// is no less than the march of 256 samples in vectors.)
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <rastrum/terrain/shadow_ray.hpp>

namespace rastrum::terrain {

inline constexpr int kSubBands = 2;
/// Columns a block: its cells are copied, turned and tiled, before they are swept.
inline constexpr int kSweepBlock = 16;

/// One cell that rays of a part of a band may enter in a column.
struct SweepEntry {
  std::int32_t row = 0;  ///< from SweepColumn::row
  float upper = 0;       ///< X_e·tau at the earliest; +inf never
  float lower = 0;       ///< at the latest; +inf where a ray may miss it
};

/// What lines meet in a column, for all bands alike.
struct SweepColumn {
  std::int32_t row = 0;        ///< band 0's entries lie in rows [row, row + 4)
  std::int32_t begin_row = 0;  ///< the cell whose ray is in band 0 lies in this row
  std::int32_t part = 0;       ///< of the band, in which rays of this column's cells lie
  float begin = 0;             ///< (X + 1/2)·tau
  std::array<std::int32_t, kSubBands> count{};
  std::array<std::array<SweepEntry, 4>, kSubBands> entries{};
};

/// A RayStep as the sweep sees it.
struct SweepStep {
  std::int32_t ahead = 0, across = 0;  ///< columns, rows
  float climb = 0;
};

struct Sweep {
  ShadowCaster map;
  std::vector<RayStep> steps;
  std::vector<SweepStep> along;           ///< the same
  std::vector<std::uint32_t> first_step;  ///< that lies this many columns ahead
  bool along_x = true;                    ///< X runs along the map's x; else along its y
  bool flipped = false;                   ///< against it
  int columns = 0;                        ///< of the map along X
  int rows = 0;                           ///< across
  int first_band = 0, bands = 0;
  bool cyclic = false;              ///< rows repeat, and band b is band b + rows
  float slack = 0;                  ///< bounds are widened by what float32 may round
  std::vector<SweepColumn> column;  ///< the map's, then those beyond that cast shadows on it

  /// The first step at least `ahead` columns from where the ray begins.
  [[nodiscard]] std::size_t step_at(int ahead) const {
    const auto last = static_cast<int>(first_step.size()) - 1;
    return first_step[static_cast<std::size_t>(ahead < 0 ? 0 : ahead < last ? ahead : last)];
  }
};

/// Requires steps (those of `ray`) and a map with finite heights.
[[nodiscard]] Sweep plan_sweep(const ShadowCaster& map, const SunRay& ray,
                               std::vector<RayStep> steps);

}  // namespace rastrum::terrain
