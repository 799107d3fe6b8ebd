// SPDX-License-Identifier: BSD-3-Clause
// How a map is read: tiling, filter and pyramid, one sample at a time, on any device. The SIMD
// kernels do the same on vectors of samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {

/// Level 0 first; the sizes are level 0's.
struct MapLevels {
  std::span<const ImageView<const float>> heights;
  std::span<const ImageView<const Rgba8>> colors;
  int width = 0, height = 0;
  int color_width = 0, color_height = 0;
};

/// Level 0 is the map. A cell of the next level stands for 2 × 2 cells (fewer at an odd edge): the
/// maximum of their heights, so that no peak is lost, or the mean of their colours. Holes do not
/// count; a cell of holes alone is a hole.
class Pyramid {
 public:
  /// `whole`: every level down to 1 × 1; else level 0 alone. O(cells).
  Pyramid(Shared<const Image<float>> heights, Shared<const Image<Rgba8>> colors, bool whole);
  Pyramid(Pyramid&&) = default;
  Pyramid& operator=(Pyramid&&) = default;
  [[nodiscard]] bool is_of(const Terrain& terrain, bool whole) const {
    return heights_ == terrain.heights() && colors_ == terrain.colors() && whole_ == whole;
  }
  [[nodiscard]] int height_levels() const { return static_cast<int>(height_views_.size()); }
  [[nodiscard]] const ImageView<const float>& heights(int level) const {
    return height_views_[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] const ImageView<const Rgba8>& colors(int level) const {
    return color_views_[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] MapLevels levels() const {
    return {height_views_,      color_views_,     heights_->width(),
            heights_->height(), colors_->width(), colors_->height()};
  }
  /// Beyond the terrain itself.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  Shared<const Image<float>> heights_;
  Shared<const Image<Rgba8>> colors_;
  bool whole_;
  // The views need that moved images keep the address of their pixels.
  std::vector<Image<float>> height_levels_;
  std::vector<Image<Rgba8>> color_levels_;
  std::vector<ImageView<const float>> height_views_;
  std::vector<ImageView<const Rgba8>> color_views_;
};

/// A cell of the next coarser level.
template <class T>
struct HalvedCell {
  ImageView<const T> fine;
  [[nodiscard]] RASTRUM_HD T operator()(int x, int y) const;
};

/// Offsets are cells from the corner of the camera's cell.
struct MapView {
  MapLevels levels{};
  MapFilter filter = MapFilter::none;
  Tiling tiling = Tiling::repeat;
  std::int32_t cell_x = 0, cell_y = 0;
  int width = 0, height = 0;
  float color_x = 1, color_y = 1;  ///< texels of the colours per cell
  int color_level = 0;             ///< of the colours' pyramid, for level 0 of the heights

  MapView() = default;
  MapView(const MapLevels& levels, const TerrainOptions& options, const SharedSetup& setup);
  MapView(const Pyramid& pyramid, const TerrainOptions& options, const SharedSetup& setup)
      : MapView(pyramid.levels(), options, setup) {}

  [[nodiscard]] RASTRUM_HD float height_at(float x, float y, int level) const;
  [[nodiscard]] RASTRUM_HD Rgba8 color_at(float x, float y, int level) const;
  /// The index of the cell in its level; not for MapFilter::bilinear.
  [[nodiscard]] RASTRUM_HD std::int32_t cell_at(float x, float y, int level) const;
  /// The last level that exists, from `level` on down.
  [[nodiscard]] RASTRUM_HD int height_level(int level) const {
    const int last = static_cast<int>(levels.heights.size()) - 1;
    return level < last ? level : last;
  }
  [[nodiscard]] RASTRUM_HD const ImageView<const float>& heights(int level) const {
    return levels.heights[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] RASTRUM_HD const ImageView<const Rgba8>& colors(int level) const {
    return levels.colors[static_cast<std::size_t>(level)];
  }
  /// Whether a cell's colour has the cell's index.
  [[nodiscard]] RASTRUM_HD bool colors_match() const {
    return filter != MapFilter::bilinear && levels.color_width == width &&
           levels.color_height == height;
  }
};

/// Fog over `color`, of which `clear` / 256 are left.
[[nodiscard]] RASTRUM_HD inline Rgba8 faded(Rgba8 color, Rgba8 fog, std::uint32_t clear) {
  const auto mix = [clear](std::uint32_t c, std::uint32_t f) {
    return static_cast<std::uint8_t>((c * clear + f * (256 - clear) + 128) >> 8);
  };
  return {mix(color.r, fog.r), mix(color.g, fog.g), mix(color.b, fog.b), 255};
}

namespace map_detail {

[[nodiscard]] RASTRUM_HD inline float join(const float* heights, int n) {
  float highest = heights[0];
  for (int i = 1; i < n; ++i)
    if (!(heights[i] <= highest) && !std::isnan(heights[i])) highest = heights[i];
  return highest;
}

[[nodiscard]] RASTRUM_HD inline Rgba8 join(const Rgba8* colors, int n) {
  const auto mean = [&](std::uint8_t Rgba8::*channel) {
    int sum = n / 2;
    for (int i = 0; i < n; ++i) sum += colors[i].*channel;
    return static_cast<std::uint8_t>(sum / n);
  };
  return {mean(&Rgba8::r), mean(&Rgba8::g), mean(&Rgba8::b), 255};
}

/// A position along one axis of the colours, in texels.
[[nodiscard]] RASTRUM_HD inline float texels(std::int32_t cell, float within, int size,
                                             float texels_a_cell, Tiling tiling) {
  // Every second copy of the map is mirrored.
  if (tiling == Tiling::mirror &&
      tiled(cell, 2 * static_cast<std::int64_t>(size), Tiling::repeat) >= size)
    within = 1 - within;
  if ((tiling == Tiling::clamp || tiling == Tiling::none) && (cell < 0 || cell >= size))
    within = cell < 0 ? 0.0F : 1.0F;
  return (static_cast<float>(tiled(cell, size, tiling)) + within) * texels_a_cell;
}

}  // namespace map_detail

template <class T>
RASTRUM_HD T HalvedCell<T>::operator()(int x, int y) const {
  T cells[4]{};
  int n = 0;
  for (int v = 2 * y; v < 2 * y + 2 && v < fine.height; ++v)
    for (int u = 2 * x; u < 2 * x + 2 && u < fine.width; ++u) cells[n++] = fine(u, v);
  return map_detail::join(cells, n);
}

RASTRUM_HD inline float MapView::height_at(float x, float y, int level) const {
  if (is_beyond(cell_x + static_cast<std::int32_t>(std::floor(x)), width, tiling) ||
      is_beyond(cell_y + static_cast<std::int32_t>(std::floor(y)), height, tiling))
    return NAN;
  if (filter == MapFilter::bilinear) {
    x -= 0.5F;
    y -= 0.5F;
    const float x0 = std::floor(x), y0 = std::floor(y), tx = x - x0, ty = y - y0;
    const std::int32_t i = cell_x + static_cast<std::int32_t>(x0);
    const std::int32_t j = cell_y + static_cast<std::int32_t>(y0);
    const ImageView<const float>& map = heights(0);
    const int left = static_cast<int>(tiled(i, width, tiling));
    const int right = static_cast<int>(tiled(i + 1, width, tiling));
    const auto along = [&](std::int32_t cell) {
      const float* const row = map.row(static_cast<int>(tiled(cell, height, tiling)));
      return row[left] + tx * (row[right] - row[left]);
    };
    const float above = along(j), below = along(j + 1);
    return above + ty * (below - above);
  }
  level = height_level(level);
  return heights(level).data[cell_at(x, y, level)];
}

RASTRUM_HD inline std::int32_t MapView::cell_at(float x, float y, int level) const {
  const std::int32_t i = cell_x + static_cast<std::int32_t>(std::floor(x));
  const std::int32_t j = cell_y + static_cast<std::int32_t>(std::floor(y));
  const auto column = static_cast<std::int32_t>(tiled(i, width, tiling)) >> level;
  const auto row = static_cast<std::int32_t>(tiled(j, height, tiling)) >> level;
  return row * heights(level).width + column;
}

RASTRUM_HD inline Rgba8 MapView::color_at(float x, float y, int level) const {
  if (colors_match()) {
    level = height_level(level);
    return colors(level).data[cell_at(x, y, level)];
  }
  const float x0 = std::floor(x), y0 = std::floor(y);
  const std::int32_t i = cell_x + static_cast<std::int32_t>(x0);
  const std::int32_t j = cell_y + static_cast<std::int32_t>(y0);
  const ImageView<const Rgba8>& whole = colors(0);
  const float u = map_detail::texels(i, x - x0, width, color_x, tiling);
  const float v = map_detail::texels(j, y - y0, height, color_y, tiling);
  if (filter != MapFilter::bilinear) {
    level += color_level;
    const int last = static_cast<int>(levels.colors.size()) - 1;
    level = filter == MapFilter::none || level < 0 ? 0 : level < last ? level : last;
    const int s = static_cast<int>(u), t = static_cast<int>(v);
    return colors(level)((s < whole.width ? s : whole.width - 1) >> level,
                         (t < whole.height ? t : whole.height - 1) >> level);
  }
  const float u0 = std::floor(u - 0.5F), v0 = std::floor(v - 0.5F);
  const auto tx = static_cast<std::uint32_t>((u - 0.5F - u0) * 256);
  const auto ty = static_cast<std::uint32_t>((v - 0.5F - v0) * 256);
  const auto at = [&](int du, int dv) {
    return whole(static_cast<int>(tiled(static_cast<int>(u0) + du, whole.width, tiling)),
                 static_cast<int>(tiled(static_cast<int>(v0) + dv, whole.height, tiling)));
  };
  const Rgba8 c[4] = {at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
  const auto mix = [&](std::uint8_t Rgba8::*channel) {
    const std::uint32_t above = c[0].*channel * (256 - tx) + c[1].*channel * tx;
    const std::uint32_t below = c[2].*channel * (256 - tx) + c[3].*channel * tx;
    return static_cast<std::uint8_t>((above * (256 - ty) + below * ty + 32768) >> 16);
  };
  return {mix(&Rgba8::r), mix(&Rgba8::g), mix(&Rgba8::b), 255};
}

}  // namespace rastrum::terrain
