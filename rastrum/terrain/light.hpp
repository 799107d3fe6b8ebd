// The stage before the renderer: sun and shadows make lit colours, so that the renderer only
// samples heights and colours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include <rastrum/core/image.hpp>
#include <rastrum/terrain/shadows.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

enum class Shadows : std::uint8_t {
  none,
  accumulated,  ///< paper 3: colour · √(1 / (1 + n)), n the hidden samples of a march
  sharp,        ///< colour · ambient where the sun is hidden
  soft,         ///< between the two by the part of the sun's disc that is seen
};

struct Light {
  Sun sun{};
  Shadows shadows = Shadows::none;
  /// Slopes get ToSun::shade. For colours that are painted without light; satellite pictures have
  /// it.
  bool hill_shading = false;
  float ambient = 0.45F;           ///< of a colour, where no sun is; [0, 1]
  double sun_radius_deg = 0.2666;  ///< of soft shadows
  March march{};                   ///< of accumulated ones
  /// Where colours and heights differ in size the coarser ones are read between the centres of
  /// their cells, as MapFilter::bilinear reads heights; else each cell has one light, each texel
  /// one colour.
  bool smooth = false;
};

/// The sky in the light of the sun, as FutSpace's dims with it (paper 3's program; the paper gives
/// no rule, so this is ours): `by_day` where the sun stands 30° high or more, from there on falling
/// linearly to a sixteenth at −6°, the end of civil twilight, and staying so.
[[nodiscard]] Rgba8 sky_in(Rgba8 by_day, const Sun& sun) noexcept;

/// The colours of a map in this light, opaque, as fine as the finer of heights and colours; the
/// others are repeated, or `smooth`. Empty colours are colors_by_height.
/// Cost: the shadows', and O(cells). Throws Error{invalid_argument} for what no light can be.
[[nodiscard]] Image<Rgba8> lit_colors(const HeightMap& map, const Light& light,
                                      const ShadowOptions& options = {});

/// Heights of n points of the plane; called from several threads at once.
using HeightFunction =
    std::function<void(const double* x, const double* y, std::size_t n, float* heights)>;

/// A terrain of a function: height_color between `low` and `high`, with slopes by central
/// differences, in this light. Shadows are by the march of each visible sample (paper 3's
/// generate_shadowmap with a function), `sharp` dark where any sample hides the sun and `soft`
/// where more and more do: there are no cells that could be traversed.
[[nodiscard]] Terrain function_terrain(HeightFunction function, double low, double high,
                                       const Light& light);

}  // namespace rastrum::terrain
