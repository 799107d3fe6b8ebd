// SPDX-License-Identifier: BSD-3-Clause
// An upper bound of the heights in a rectangle of a map, from maxima of 16 × 16 cells and coarser:
// what lies under it need not be sampled where all of it would stay hidden. On hills most samples
// are; 88 % of a frame's here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/terrain.hpp>

namespace rastrum::terrain {

/// Whole cells, ends included, before tiling.
struct CellRange {
  std::int64_t first, last;
};

/// The cell of the level above that stands for `edge` × `edge` of `fine`: the highest of them, −inf
/// where all are holes.
struct HighestCell {
  ImageView<const float> fine;
  int edge;
  [[nodiscard]] RASTRUM_HD float operator()(int x, int y) const {
    float highest = -std::numeric_limits<float>::infinity();
    for (int v = y * edge; v < (y + 1) * edge && v < fine.height; ++v)
      for (int u = x * edge; u < (x + 1) * edge && u < fine.width; ++u)
        highest = fine(u, v) > highest ? fine(u, v) : highest;  // not with NaN
    return highest;
  }
};

/// The levels, wherever they lie.
struct CeilingView {
  static constexpr int kFirstLevel = 4;
  std::span<const ImageView<const float>> levels;  ///< of cells of 2⁴, 2⁵, …
  int width = 0, height = 0;                       ///< of the map
  int first_level = kFirstLevel;                   ///< of the list: its cells are of 2^first_level

  /// No height in x × y of the tiled map exceeds it; −inf where all are holes. At most 25 reads.
  [[nodiscard]] RASTRUM_HD float over(CellRange x, CellRange y, Tiling tiling) const;
  /// The same by cells of the list's `level` alone.
  [[nodiscard]] RASTRUM_HD float on_level(int level, CellRange x, CellRange y, Tiling tiling) const;
};

class Ceiling {
 public:
  /// O(cells), once a map.
  explicit Ceiling(Shared<const Image<float>> heights);
  Ceiling(Ceiling&&) = default;
  Ceiling& operator=(Ceiling&&) = default;
  [[nodiscard]] bool is_of(const Terrain& terrain) const { return heights_ == terrain.heights(); }

  [[nodiscard]] CeilingView view() const { return {views_, heights_->width(), heights_->height()}; }
  [[nodiscard]] float over(CellRange x, CellRange y, Tiling tiling) const {
    return view().over(x, y, tiling);
  }
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  Shared<const Image<float>> heights_;
  std::vector<Image<float>> levels_;
  std::vector<ImageView<const float>> views_;
};

namespace ceiling_detail {

/// The cells of a map that a range falls on: one piece, or two where it runs over the end of a map
/// that repeats. `size` cells in all.
struct Pieces {
  CellRange at[2];
  int count;
};

[[nodiscard]] RASTRUM_HD inline Pieces pieces_of(CellRange r, std::int64_t size, Tiling tiling) {
  const auto one = [](std::int64_t a, std::int64_t b) { return Pieces{{{a, b}, {0, -1}}, 1}; };
  if (tiling == Tiling::clamp || tiling == Tiling::none)
    return one(tiled(r.first, size, tiling), tiled(r.last, size, tiling));
  if (r.last - r.first + 1 >= size) return one(0, size - 1);
  const std::int64_t a = tiled(r.first, size, tiling), b = tiled(r.last, size, tiling);
  if (tiling == Tiling::repeat) {
    if (a <= b) return one(a, b);
    return {{{a, size - 1}, {0, b}}, 2};
  }
  // Mirrored: up to an edge and back, or within one image of the map, either way round.
  const std::int64_t period = 2 * size, from = tiled(r.first, period, Tiling::repeat),
                     to = tiled(r.last, period, Tiling::repeat);
  const std::int64_t low = a < b ? a : b, high = a < b ? b : a;
  if (to < from) return one(0, high);
  if (from < size && to >= size) return one(low, size - 1);
  return one(low, high);
}

}  // namespace ceiling_detail

RASTRUM_HD inline float CeilingView::over(CellRange x, CellRange y, Tiling tiling) const {
  const std::int64_t across = x.last - x.first, down = y.last - y.first;
  const std::int64_t longest = across > down ? across : down;
  int level = 0;
  while (level + 1 < static_cast<int>(levels.size()) && (longest >> (first_level + level)) > 3)
    ++level;
  return on_level(level, x, y, tiling);
}

RASTRUM_HD inline float CeilingView::on_level(int level, CellRange x, CellRange y,
                                              Tiling tiling) const {
  const ImageView<const float>& maxima = levels[static_cast<std::size_t>(level)];
  const ceiling_detail::Pieces columns = ceiling_detail::pieces_of(x, width, tiling);
  const ceiling_detail::Pieces rows = ceiling_detail::pieces_of(y, height, tiling);
  const int shift = first_level + level;
  const auto cell = [shift](std::int64_t i) { return static_cast<int>(i >> shift); };
  float highest = -std::numeric_limits<float>::infinity();
  for (int v = 0; v < rows.count; ++v)
    for (int u = 0; u < columns.count; ++u)
      for (int j = cell(rows.at[v].first); j <= cell(rows.at[v].last); ++j)
        for (int i = cell(columns.at[u].first); i <= cell(columns.at[u].last); ++i)
          highest = maxima(i, j) > highest ? maxima(i, j) : highest;
  return highest;
}

}  // namespace rastrum::terrain
