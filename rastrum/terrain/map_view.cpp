// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/map_view.hpp>

namespace rastrum::terrain {
namespace {

template <class T>
void fill_levels(const Image<T>& map, bool whole, std::vector<Image<T>>& levels,
                 std::vector<ImageView<const T>>& views) {
  views.push_back(map.view());
  while (whole && (views.back().width > 1 || views.back().height > 1)) {
    const HalvedCell<T> halved{views.back()};
    Image<T> coarse((halved.fine.width + 1) / 2, (halved.fine.height + 1) / 2);
    for (int y = 0; y < coarse.height(); ++y)
      for (int x = 0; x < coarse.width(); ++x) coarse(x, y) = halved(x, y);
    views.push_back(std::as_const(coarse).view());
    levels.push_back(std::move(coarse));
  }
}

}  // namespace

Pyramid::Pyramid(Shared<const Image<float>> heights, Shared<const Image<Rgba8>> colors, bool whole)
    : heights_(std::move(heights)), colors_(std::move(colors)), whole_(whole) {
  fill_levels(*heights_, whole, height_levels_, height_views_);
  fill_levels(*colors_, whole, color_levels_, color_views_);
}

std::uint64_t Pyramid::bytes() const {
  std::uint64_t bytes = 0;
  for (const Image<float>& level : height_levels_) bytes += level.pixels().size_bytes();
  for (const Image<Rgba8>& level : color_levels_) bytes += level.pixels().size_bytes();
  return bytes;
}

MapView::MapView(const MapLevels& given, const TerrainOptions& options, const SharedSetup& setup)
    : levels(given),
      filter(options.filter),
      tiling(options.tiling),
      cell_x(setup.cell_x),
      cell_y(setup.cell_y),
      width(given.width),
      height(given.height),
      color_x(static_cast<float>(given.color_width) / static_cast<float>(width)),
      color_y(static_cast<float>(given.color_height) / static_cast<float>(height)),
      color_level(std::ilogb(std::max(color_x, color_y))) {}

}  // namespace rastrum::terrain
