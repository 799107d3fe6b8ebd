// Where the sun does not reach a height map.
//
// The surface. A map is made of columns: cell (i, j) is the square [i, i + 1) × [j, j + 1), flat at
// its height (as MapFilter::none draws it), tiled beyond the map's edge. A cell is judged at the
// middle of its top. From there a ray goes to the sun; the cell is in shadow where the ray runs
// through another cell below that cell's top. The ray climbs, so it is lowest where it enters:
//
//     in shadow  ⇔  some cell entered at distance t > 0 has  height > own height + t ·
//     tan(elevation)
//
// with `>` in float64. A cell whose corner alone is touched (crossed for less than 10⁻⁹ of the way)
// does not count. Holes (heights that are not finite) neither cast shadows nor receive any. The sun
// at or below the horizon leaves everything in shadow; above it, it is taken no lower than makes
// the longest shadow 65,536 cells long.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <rastrum/core/config.hpp>
#include <rastrum/core/image.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

struct Sun {
  double azimuth_deg = 315;   ///< clockwise from north (−y): 90 is east (+x)
  double elevation_deg = 35;  ///< above the horizon, up to 90
};

struct ShadowOptions {
  Tiling tiling = Tiling::repeat;
  Device device = Device::threads;
  int threads = 0;           ///< 0: all
  std::optional<Isa> isa{};  ///< none: the best this machine has
};

/// 1 where a cell is in shadow, else 0; exact by the definition above, the same on every device.
/// Cost: two lines of a sweep a cell and column of the map, further columns where the longest
/// shadow reaches beyond the map's edge, and a traversal of the few cells that the sweep cannot
/// decide (shadow_sweep.hpp). Throws Error{invalid_argument} for a sun that is not finite or above
/// 90°, Error{no_device}.
[[nodiscard]] Image<std::uint8_t> sharp_shadows(ImageView<const float> heights, const Sun& sun,
                                                const ShadowOptions& options = {});

/// How much of the sun's disc each cell sees, 0 to 255: the mean of sharp_shadows over 16 points
/// spread evenly over a disc of angular radius `radius_deg` (the real one has 0.2666°).
/// Cost: 16 × sharp_shadows.
[[nodiscard]] Image<std::uint8_t> soft_light(ImageView<const float> heights, const Sun& sun,
                                             double radius_deg, const ShadowOptions& options = {});
/// `seen` of so many points, as that mean.
[[nodiscard]] RASTRUM_HD constexpr std::uint8_t part_of_suns(std::uint32_t seen,
                                                             std::uint32_t points) {
  return static_cast<std::uint8_t>((seen * 255 + points / 2) / points);
}

/// The march of paper 3 (6.2, listing 6.4): samples k = 1 … steps − 1 along the ray.
struct March {
  double distance = 1024;  ///< d_m, cells along the ray
  int steps = 256;         ///< d_c, 2 to 65,536
};

/// How many of a cell's samples hide the sun: those whose cell is higher than the ray, which starts
/// at the cell's corner as in the paper; sample k lies k · distance / steps along the unit vector
/// to the sun. Cells are floored where the paper's code truncates (which differs at negative
/// coordinates), and own height + climb is compared in float32. Holes count as in sharp_shadows.
/// Cost: cells × steps. Throws Error{invalid_argument} for a sun or march out of range.
[[nodiscard]] Image<std::uint16_t> hidden_samples(ImageView<const float> heights, const Sun& sun,
                                                  const March& march = {},
                                                  const ShadowOptions& options = {});

}  // namespace rastrum::terrain
