#include <rastrum/terrain/map_view.hpp>

#include <limits>

namespace rastrum::terrain {
namespace {

float join(const float* heights, int n) {
  float highest = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < n; ++i)
    if (!(heights[i] <= highest) && !std::isnan(heights[i])) highest = heights[i];
  return highest;
}

Rgba8 join(const Rgba8* colors, int n) {
  const auto mean = [&](std::uint8_t Rgba8::*channel) {
    int sum = n / 2;
    for (int i = 0; i < n; ++i) sum += colors[i].*channel;
    return static_cast<std::uint8_t>(sum / n);
  };
  return {mean(&Rgba8::r), mean(&Rgba8::g), mean(&Rgba8::b), 255};
}

template <class T>
Image<T> halved(const Image<T>& fine) {
  Image<T> coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2);
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) {
      T cells[4];
      int n = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, fine.height()); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, fine.width()); ++u) cells[n++] = fine(u, v);
      coarse(x, y) = join(cells, n);
    }
  return coarse;
}

template <class T>
void fill_levels(const Image<T>& map, std::vector<Image<T>>& levels) {
  for (const Image<T>* last = &map; last->width() > 1 || last->height() > 1; last = &levels.back())
    levels.push_back(halved(*last));
}

/// A position along one axis of the colours, in texels, from a cell and where in it one is.
float texels(std::int32_t cell, float within, int size, float texels_a_cell, Tiling tiling) {
  // Every second map lies mirrored.
  if (tiling == Tiling::mirror &&
      tiled(cell, 2 * static_cast<std::int64_t>(size), Tiling::repeat) >= size)
    within = 1 - within;
  // Beyond a clamped edge it is the edge.
  if (tiling == Tiling::clamp && (cell < 0 || cell >= size)) within = cell < 0 ? 0.0F : 1.0F;
  return (static_cast<float>(tiled(cell, size, tiling)) + within) * texels_a_cell;
}

}  // namespace

Pyramid::Pyramid(std::shared_ptr<const Image<float>> heights,
                 std::shared_ptr<const Image<Rgba8>> colors, bool whole)
    : heights_(std::move(heights)), colors_(std::move(colors)), whole_(whole) {
  if (!whole) return;
  // Growing would move the level that the next one is made from.
  height_levels_.reserve(16);
  color_levels_.reserve(16);
  fill_levels(*heights_, height_levels_);
  fill_levels(*colors_, color_levels_);
}

std::uint64_t Pyramid::bytes() const {
  std::uint64_t bytes = 0;
  for (const Image<float>& level : height_levels_) bytes += level.pixels().size_bytes();
  for (const Image<Rgba8>& level : color_levels_) bytes += level.pixels().size_bytes();
  return bytes;
}

MapView::MapView(const Pyramid& p, const TerrainOptions& options, const Setup& setup)
    : pyramid(&p),
      filter(options.filter),
      tiling(options.tiling),
      cell_x(setup.cell_x),
      cell_y(setup.cell_y),
      width(p.heights(0).width()),
      height(p.heights(0).height()),
      color_x(static_cast<float>(p.colors(0).width()) / static_cast<float>(width)),
      color_y(static_cast<float>(p.colors(0).height()) / static_cast<float>(height)),
      color_level(std::ilogb(std::max(color_x, color_y))) {}

float MapView::height_at(float x, float y, int level) const {
  const auto column = [this](std::int32_t cell) {
    return static_cast<int>(tiled(cell, width, tiling));
  };
  const auto row = [this](std::int32_t cell) {
    return static_cast<int>(tiled(cell, height, tiling));
  };
  if (filter == Filter::bilinear) {
    x -= 0.5F;
    y -= 0.5F;
    const float x0 = std::floor(x), y0 = std::floor(y), tx = x - x0, ty = y - y0;
    const std::int32_t i = cell_x + static_cast<std::int32_t>(x0);
    const std::int32_t j = cell_y + static_cast<std::int32_t>(y0);
    const Image<float>& map = pyramid->heights(0);
    const auto along = [&](int at_row) {
      const float left = map(column(i), at_row), right = map(column(i + 1), at_row);
      return left + tx * (right - left);
    };
    const float above = along(row(j)), below = along(row(j + 1));
    return above + ty * (below - above);
  }
  level = std::min(level, pyramid->height_levels() - 1);
  return pyramid->heights(level).pixels()[static_cast<std::size_t>(cell_at(x, y, level))];
}

std::int32_t MapView::cell_at(float x, float y, int level) const {
  const std::int32_t i = cell_x + static_cast<std::int32_t>(std::floor(x));
  const std::int32_t j = cell_y + static_cast<std::int32_t>(std::floor(y));
  const auto column = static_cast<std::int32_t>(tiled(i, width, tiling)) >> level;
  const auto row = static_cast<std::int32_t>(tiled(j, height, tiling)) >> level;
  return row * pyramid->heights(level).width() + column;
}

Rgba8 MapView::color_at(float x, float y, int level) const {
  if (colors_match()) {
    level = std::min(level, pyramid->height_levels() - 1);
    return pyramid->colors(level).pixels()[static_cast<std::size_t>(cell_at(x, y, level))];
  }
  const float x0 = std::floor(x), y0 = std::floor(y);
  const std::int32_t i = cell_x + static_cast<std::int32_t>(x0);
  const std::int32_t j = cell_y + static_cast<std::int32_t>(y0);
  const Image<Rgba8>& whole = pyramid->colors(0);
  const float u = texels(i, x - x0, width, color_x, tiling);
  const float v = texels(j, y - y0, height, color_y, tiling);
  if (filter != Filter::bilinear) {
    level = std::clamp(level + color_level, 0, pyramid->color_levels() - 1);
    if (filter == Filter::none) level = 0;
    const int s = std::min(static_cast<int>(u), whole.width() - 1);
    const int t = std::min(static_cast<int>(v), whole.height() - 1);
    return pyramid->colors(level)(s >> level, t >> level);
  }
  const float u0 = std::floor(u - 0.5F), v0 = std::floor(v - 0.5F);
  const auto tx = static_cast<std::uint32_t>((u - 0.5F - u0) * 256);
  const auto ty = static_cast<std::uint32_t>((v - 0.5F - v0) * 256);
  const auto at = [&](int du, int dv) {
    return whole(static_cast<int>(tiled(static_cast<int>(u0) + du, whole.width(), tiling)),
                 static_cast<int>(tiled(static_cast<int>(v0) + dv, whole.height(), tiling)));
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
