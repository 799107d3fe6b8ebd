#include <rastrum/terrain/ceiling.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace rastrum::terrain {
namespace {

constexpr int kFirstLevel = 4;

/// Maxima of `edge` × `edge` cells.
Image<float> maxima(const Image<float>& fine, int edge) {
  Image<float> coarse((fine.width() + edge - 1) / edge, (fine.height() + edge - 1) / edge);
  std::fill(coarse.pixels().begin(), coarse.pixels().end(),
            -std::numeric_limits<float>::infinity());
  for (int y = 0; y < fine.height(); ++y)
    for (int x = 0; x < fine.width(); ++x) {
      float& highest = coarse(x / edge, y / edge);
      const float h = fine(x, y);
      highest = h > highest ? h : highest;  // not with NaN
    }
  return coarse;
}

/// The cells of a map that a range falls on: one piece, or two where it runs over the end of a map
/// that repeats. `size` cells in all.
struct Pieces {
  std::array<CellRange, 2> at;
  int count;
};
Pieces pieces_of(CellRange r, std::int64_t size, Tiling tiling) {
  const auto one = [](std::int64_t a, std::int64_t b) { return Pieces{{{{a, b}, {0, -1}}}, 1}; };
  if (tiling == Tiling::clamp)
    return one(tiled(r.first, size, tiling), tiled(r.last, size, tiling));
  if (r.last - r.first + 1 >= size) return one(0, size - 1);
  const std::int64_t a = tiled(r.first, size, tiling), b = tiled(r.last, size, tiling);
  if (tiling == Tiling::repeat) {
    if (a <= b) return one(a, b);
    return {{{{a, size - 1}, {0, b}}}, 2};
  }
  // Mirrored: up to an edge and back, or within one image of the map, either way round.
  const std::int64_t period = 2 * size, from = tiled(r.first, period, Tiling::repeat),
                     to = tiled(r.last, period, Tiling::repeat);
  if (to < from) return one(0, std::max(a, b));
  if (from < size && to >= size) return one(std::min(a, b), size - 1);
  return one(std::min(a, b), std::max(a, b));
}

}  // namespace

Ceiling::Ceiling(std::shared_ptr<const Image<float>> heights) : heights_(std::move(heights)) {
  levels_.push_back(maxima(*heights_, 1 << kFirstLevel));
  while (levels_.back().width() > 1 || levels_.back().height() > 1)
    levels_.push_back(maxima(levels_.back(), 2));
}

std::uint64_t Ceiling::bytes() const {
  std::uint64_t bytes = 0;
  for (const Image<float>& level : levels_) bytes += level.pixels().size_bytes();
  return bytes;
}

float Ceiling::over(CellRange x, CellRange y, Tiling tiling) const {
  const std::int64_t longest = std::max(x.last - x.first, y.last - y.first);
  std::size_t level = 0;
  while (level + 1 < levels_.size() && (longest >> (kFirstLevel + level)) > 3) ++level;
  const Image<float>& maxima = levels_[level];
  const Pieces across = pieces_of(x, heights_->width(), tiling);
  const Pieces down = pieces_of(y, heights_->height(), tiling);
  const auto cell = [level](std::int64_t i) {
    return static_cast<int>(i >> (kFirstLevel + level));
  };
  float highest = -std::numeric_limits<float>::infinity();
  for (int v = 0; v < down.count; ++v)
    for (int u = 0; u < across.count; ++u) {
      const CellRange rows = down.at[static_cast<std::size_t>(v)];
      const CellRange columns = across.at[static_cast<std::size_t>(u)];
      for (int j = cell(rows.first); j <= cell(rows.last); ++j)
        for (int i = cell(columns.first); i <= cell(columns.last); ++i)
          highest = std::max(highest, maxima(i, j));
    }
  return highest;
}

}  // namespace rastrum::terrain
