// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/shadow_reach.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rastrum::terrain {
namespace {

/// Calls f(tile) for the tiles of coordinates [begin, end).
template <class F>
void each_tile(std::int64_t begin, std::int64_t end, std::int64_t size, bool flipped, Tiling tiling,
               const F& f) {
  constexpr std::int64_t kEdge = HeightTiles::kEdge;
  for (std::int64_t i = begin; i < end;) {
    const std::int64_t of_plane = flipped ? size - 1 - i : i;
    const std::int64_t at = tiled(of_plane, size, tiling);
    f(static_cast<int>(at / kEdge));
    const bool mirrored =
        tiling == Tiling::mirror && tiled(of_plane, 2 * size, Tiling::repeat) >= size;
    // To the end of the tile or of the map. A clamped coordinate stays at least that long.
    i += flipped != mirrored ? at % kEdge + 1 : std::min(kEdge - at % kEdge, size - at);
  }
}

}  // namespace

std::vector<int> reach_of(const ShadowCaster& map, const HeightTiles& tiles,
                          const SweepLines& lines, int block, int blocks) {
  // For float64's rounding of lines and climbs, and for corners that count as one crossing.
  constexpr double kRows = 1e-3;
  const double margin = 1e-6 * map.relief();
  const double highest = static_cast<double>(map.highest), lowest = static_cast<double>(map.lowest);
  const auto groups = static_cast<std::size_t>((lines.bands + kReachBands - 1) / kReachBands);
  const int own = (lines.columns + block - 1) / block;
  std::vector<int> reach(groups, own), across;
  // Rays below this height, less their climb from X = 0 on, are hidden or do not exist.
  std::vector<double> hidden(groups, lowest - (lines.columns - 0.5) * lines.tau);
  for (int b = own; b < blocks; ++b) {
    const double x0 = static_cast<double>(b) * block, x1 = x0 + block;
    if (highest - x0 * lines.tau + margin <= *std::ranges::min_element(hidden)) break;
    across.clear();
    each_tile(std::int64_t{b} * block, std::int64_t{b + 1} * block, lines.columns, lines.flipped,
              map.tiling, [&](int tile) { across.push_back(tile); });
    const double up = std::min(lines.s * x0, lines.s * x1) - kRows;
    const double down = std::max(lines.s * x0, lines.s * x1) + kRows;
    for (std::size_t g = 0; g < groups; ++g) {
      const double c = lines.first_band + static_cast<double>(g) * kReachBands;
      double least = highest, most = lowest;
      each_tile(static_cast<std::int64_t>(std::floor(c + up)),
                static_cast<std::int64_t>(std::floor(c + kReachBands + down)) + 1, lines.rows,
                false, map.tiling, [&](int row) {
                  for (const int column : across) {
                    const std::size_t tile =
                        lines.along_x ? tiles.at(column, row) : tiles.at(row, column);
                    least = std::min(least, static_cast<double>(tiles.lowest[tile]));
                    most = std::max(most, static_cast<double>(tiles.highest[tile]));
                  }
                });
      if (most - x0 * lines.tau + margin <= hidden[g]) continue;
      reach[g] = b + 1;
      hidden[g] = std::max(hidden[g], least - x1 * lines.tau);
    }
  }
  return reach;
}

}  // namespace rastrum::terrain
