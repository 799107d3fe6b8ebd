// SPDX-License-Identifier: BSD-3-Clause
// The stage before a terrain's renderer: sun and shadows make lit colours, so that the renderer
// only samples heights and colours. Terrains that are functions are lit as they are sampled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/config.hpp>
#include <rastrum/device.hpp>
#include <rastrum/function.hpp>
#include <rastrum/image.hpp>
#include <rastrum/terrain.hpp>

namespace RASTRUM_API rastrum {
namespace terrain {

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

/// 1 where the ray from the middle of a cell's top to the sun meets a higher cell, else 0: exact,
/// the same on every device. Holes hide nothing. Cost: a sweep over the map's columns, O(1) a cell;
/// further columns where the longest shadow reaches beyond the map's edge; and a traversal for the
/// few cells that the sweep cannot decide. Throws Error{invalid_argument} for a sun that is not
/// finite or above 90°.
[[nodiscard]] Image<std::uint8_t> sharp_shadows(ImageView<const float> heights, const Sun& sun,
                                                const ShadowOptions& options = {});

/// How much of the sun's disc each cell sees, 0 to 255: the mean of sharp_shadows over 16 points
/// spread evenly over a disc of angular radius `radius_deg`, 0 to 45° (the real one has 0.2666°).
/// Cost: 16 × sharp_shadows. Throws Error{invalid_argument} as that, and for a radius out of range.
[[nodiscard]] Image<std::uint8_t> soft_light(ImageView<const float> heights, const Sun& sun,
                                             double radius_deg, const ShadowOptions& options = {});

/// The march of paper 3 (6.2, listing 6.4): samples k = 1 … steps − 1 along the ray.
struct March {
  double distance = 1024;  ///< d_m, cells along the ray
  int steps = 256;         ///< d_c, 2 to 65,536
};

/// How many samples of a march hide the sun from a cell: samples whose cell is higher than the ray.
/// The ray starts at the cell's corner, as in the paper; sample k lies k · distance / steps along
/// the unit vector to the sun. Cells are rounded down where the paper's code truncates (which
/// differs at negative coordinates), and the ray's height, the cell's own + its climb, is compared
/// in float32. Holes count as in sharp_shadows. Cost: cells × steps. Throws Error{invalid_argument}
/// for a sun or march out of range.
[[nodiscard]] Image<std::uint16_t> hidden_samples(ImageView<const float> heights, const Sun& sun,
                                                  const March& march = {},
                                                  const ShadowOptions& options = {});

enum class Shadows : std::uint8_t {
  none,
  accumulated,  ///< paper 3: colour · √(1 / (1 + n)), n the hidden samples of a march
  sharp,        ///< colour · ambient where the sun is hidden
  soft,         ///< between the two, by the part of the sun's disc that is seen
};

struct Light {
  Sun sun{};
  Shadows shadows = Shadows::none;
  /// Whether slopes get ambient + (1 − ambient) · max(0, cosine between normal and sun). It is for
  /// colours that are painted without light; satellite pictures have light in them.
  bool hill_shading = false;
  float ambient = 0.45F;           ///< share of a colour where no sun is, [0, 1]
  double sun_radius_deg = 0.2666;  ///< for `soft`
  March march{};                   ///< for `accumulated`
  /// If colours and heights differ in size, the coarser ones are read between the centres of their
  /// cells, as MapFilter::bilinear reads heights; else a cell has one light, a texel one colour.
  bool smooth = false;
};

/// The sky in the light of the sun, dimmed as in FutSpace (paper 3's program; the paper gives no
/// rule, so this is ours). It is `by_day` if the sun stands 30° high or more, falls linearly from
/// there to a sixteenth at −6°, the end of civil twilight, and stays so.
[[nodiscard]] Rgba8 sky_in(Rgba8 by_day, const Sun& sun) noexcept;

/// The colours of a map in this light, opaque, as fine as the finer of heights and colours; the
/// others are repeated, or read as Light::smooth says. Empty colours become hues of the heights,
/// from lowland to snow. Cost: that of the shadows, and O(cells). Throws Error{invalid_argument}
/// for a light out of range.
[[nodiscard]] Image<Rgba8> lit_colors(const HeightMap& map, const Light& light,
                                      const ShadowOptions& options = {});

/// The greatest `finer` of colors_of_heights.
inline constexpr int kMaxFiner = 16;

/// The colours of a map by its heights as numbers, in units of which each is `cells_a_unit` cells
/// high; opaque, whatever alpha `colors` have. There are `finer` times as many texels along each
/// side, up to kMaxFiner. Heights then lie between the cells' centres, as MapFilter::bilinear reads
/// them, and are mapped at each texel, so that steps stay steps. 0: as fine as 2²⁴ texels let it
/// be, 1 to 4. Holes are ScalarColors::nan. Cost: O(cells · finer²) on `threads` (0: all). Throws
/// Error{invalid_argument} for a `finer` out of range and for colours beyond the largest image.
[[nodiscard]] Image<Rgba8> colors_of_heights(ImageView<const float> heights,
                                             const ScalarColors& colors, double cells_a_unit = 1,
                                             int finer = 1, Tiling tiling = Tiling::repeat,
                                             int threads = 0);

/// Writes the heights of n points of the plane; several threads call it at once.
using HeightFunction =
    Function<void(const double* x, const double* y, std::size_t n, float* heights)>;

/// The terrain of a function in this light. Its colours are hues from lowland at `low` to snow at
/// `high` or, if they are given, `colors` of the heights; a device leaves a terrain with these to
/// the CPU. Slopes are central differences. The shadows are those of a march from each visible
/// sample (paper 3's generate_shadowmap with a function), because there are no cells to traverse:
/// `sharp` is dark where any sample hides the sun, `soft` where more and more do.
[[nodiscard]] Terrain function_terrain(HeightFunction function, double low, double high,
                                       const Light& light, std::optional<ScalarColors> colors = {});

// Terrains that are functions of the plane, by name.

struct FunctionInfo {
  std::string_view name, description;
  double low, high;  ///< bounds of the heights
};

/// The functions of paper 3 (its figure 6.1 and its program's list) and fractal noise. Their
/// arithmetic is ours (no sine of the C library), so their bits are the same on every machine.
[[nodiscard]] const std::vector<FunctionInfo>& named_functions();

/// The function of this name. Throws Error{not_found} that lists the names.
[[nodiscard]] HeightFunction named_function(std::string_view name);

/// The heights from `low` to `high`.
struct HeightRange {
  double low = 0, high = 1;
};
/// The least and the greatest finite height on a grid of 128² points over [0, 1024)², for the
/// colours of expressions; (0, 1) if there is none. Cost: 128² heights.
[[nodiscard]] HeightRange sampled_range(const HeightFunction& function);

// Terrains that are formulas in a text. They are in the target Rastrum::io, because they need a
// library; Rastrum::rastrum has everything else of this file.

/// A formula of x and y in the language of muParser, such as `40*sin(x/30)*cos(y/50)`.
/// Throws Error{invalid_argument} with the place of the mistake, Error{unsupported} where the
/// library was built without muParser.
[[nodiscard]] HeightFunction expression_function(const std::string& expression);

}  // namespace terrain
}  // namespace rastrum
