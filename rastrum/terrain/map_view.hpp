// How a map is read: tiling, filter and pyramid, one sample at a time. The SIMD kernels do the same
// operations on vectors of samples for heights; colours are only read where something is visible,
// and always here.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <rastrum/core/image.hpp>
#include <rastrum/terrain/options.hpp>
#include <rastrum/terrain/setup.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

/// Level 0 is the map; a cell of each further one stands for 2 × 2 of the one before (fewer at the
/// edge of an odd size): the maximum of their heights, so that no peak is lost, or the mean of
/// their colours. Holes count for nothing; where all are holes, so is the cell.
class Pyramid {
 public:
  /// `levels` of them at most, down to 1 × 1. O(cells).
  Pyramid(std::shared_ptr<const Image<float>> heights, std::shared_ptr<const Image<Rgba8>> colors,
          bool whole);
  [[nodiscard]] bool is_of(const Terrain& terrain, bool whole) const {
    return heights_ == terrain.heights() && colors_ == terrain.colors() && whole_ == whole;
  }
  [[nodiscard]] int height_levels() const { return static_cast<int>(height_levels_.size()) + 1; }
  [[nodiscard]] int color_levels() const { return static_cast<int>(color_levels_.size()) + 1; }
  [[nodiscard]] const Image<float>& heights(int level) const {
    return level == 0 ? *heights_ : height_levels_[static_cast<std::size_t>(level) - 1];
  }
  [[nodiscard]] const Image<Rgba8>& colors(int level) const {
    return level == 0 ? *colors_ : color_levels_[static_cast<std::size_t>(level) - 1];
  }
  /// Beyond the terrain itself.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  std::shared_ptr<const Image<float>> heights_;
  std::shared_ptr<const Image<Rgba8>> colors_;
  bool whole_;
  std::vector<Image<float>> height_levels_;
  std::vector<Image<Rgba8>> color_levels_;
};

/// A map as the samples of one frame see it. Offsets are cells from the corner of the camera's
/// cell.
struct MapView {
  const Pyramid* pyramid = nullptr;
  Filter filter = Filter::none;
  Tiling tiling = Tiling::repeat;
  std::int32_t cell_x = 0, cell_y = 0;
  int width = 0, height = 0;
  float color_x = 1, color_y = 1;  ///< texels of the colours a cell
  int color_level = 0;             ///< of the colours' pyramid at level 0 of the heights'

  MapView() = default;
  MapView(const Pyramid& p, const TerrainOptions& options, const Setup& setup);

  [[nodiscard]] float height_at(float x, float y, int level) const;
  [[nodiscard]] Rgba8 color_at(float x, float y, int level) const;
  /// The index of the cell in its level; unless filtered.
  [[nodiscard]] std::int32_t cell_at(float x, float y, int level) const;
  /// A cell's colour has the cell's index.
  [[nodiscard]] bool colors_match() const {
    return filter != Filter::bilinear && pyramid->colors(0).width() == width &&
           pyramid->colors(0).height() == height;
  }
};

/// `color` with `clear` of 256 left of it.
[[nodiscard]] inline Rgba8 faded(Rgba8 color, Rgba8 fog, std::uint32_t clear) {
  const auto mix = [clear](std::uint32_t c, std::uint32_t f) {
    return static_cast<std::uint8_t>((c * clear + f * (256 - clear) + 128) >> 8);
  };
  return {mix(color.r, fog.r), mix(color.g, fog.g), mix(color.b, fog.b), 255};
}

}  // namespace rastrum::terrain
