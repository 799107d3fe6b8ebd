// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain_light.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain/function_light.hpp>
#include <rastrum/terrain/sun_march.hpp>
#include <rastrum/terrain/under_light.hpp>

namespace rastrum::terrain {
namespace {

void check(const Light& light) {
  check_enum(light.shadows, Shadows::soft, "the kind of shadows");
  if (!(light.ambient >= 0 && light.ambient <= 1)) reject("the ambient light must lie in 0 to 1");
}

Image<float> light_of(const HeightMap& map, bool shade, const Light& light,
                      const ShadowOptions& options) {
  const ImageView<const float> heights = map.heights.view();
  Image<float> factor(heights.width, heights.height);
  std::ranges::fill(factor.pixels(), 1.0F);
  if (shade) factor = hill_shading(heights, light.sun, light.ambient, options.tiling);
  const std::span<float> f = factor.pixels();
  if (light.shadows == Shadows::accumulated) {
    const Image<std::uint16_t> n = hidden_samples(heights, light.sun, light.march, options);
    for (std::size_t i = 0; i < f.size(); ++i)
      f[i] *= std::sqrt(1 / (1 + static_cast<float>(n.pixels()[i])));
  } else if (light.shadows == Shadows::sharp) {
    // Slopes that face away have no more than ambient light anyway.
    const Image<std::uint8_t> dark = sharp_shadows(heights, light.sun, options);
    for (std::size_t i = 0; i < f.size(); ++i)
      if (dark.pixels()[i] != 0) f[i] = std::min(f[i], light.ambient);
  } else if (light.shadows == Shadows::soft) {
    const Image<std::uint8_t> seen = soft_light(heights, light.sun, light.sun_radius_deg, options);
    for (std::size_t i = 0; i < f.size(); ++i) {
      const float least = std::min(f[i], light.ambient);
      f[i] = least + (f[i] - least) * (static_cast<float>(seen.pixels()[i]) / 255);
    }
  }
  return factor;
}

}  // namespace

class LitFunction final : public Surface {
 public:
  LitFunction(HeightFunction function, double low, double high, const Light& light,
              std::optional<ScalarColors> colors)
      : function_(std::move(function)),
        colors_(std::move(colors)),
        light_{low,
               high > low ? 1 / (high - low) : 0,
               light.hill_shading,
               light.shadows,
               light.ambient,
               ToSun::of(light.sun)} {
    if (light.shadows != Shadows::none) march_ = SunMarch(light.sun, light.march);
  }

  void heights(const double* x, const double* y, std::size_t n, float* out) const override {
    function_(x, y, n, out);
  }

  void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const override {
    for (std::size_t i = 0; i < n; ++i) out[i] = color(x[i], y[i]);
  }

  [[nodiscard]] std::optional<FunctionView> view() const {
    const auto* const named = function_.target<NamedHeights>();
    return named == nullptr || colors_
               ? std::nullopt
               : std::optional(FunctionView{named->function, light_, march_.steps()});
  }

 private:
  [[nodiscard]] Rgba8 color(double x, double y) const {
    const std::array<double, 5> xs{x, x - kSlopeStep, x + kSlopeStep, x, x};
    const std::array<double, 5> ys{y, y, y, y - kSlopeStep, y + kSlopeStep};
    std::array<float, 5> h{};
    function_(xs.data(), ys.data(), h.size(), h.data());
    const float factor = light_.slope(h[1], h[2], h[3], h[4]);
    const float left = light_.shadowed(factor, hidden(x, y, h[0]));
    return colors_ ? lit(shown((*colors_)(static_cast<double>(h[0]))), left)
                   : light_.color(h[0], left);
  }

  [[nodiscard]] int hidden(double x, double y, float own) const {
    return march_.hidden(function_, x, y, own, light_.shadows == Shadows::sharp);
  }

  HeightFunction function_;
  std::optional<ScalarColors> colors_;
  FunctionLight light_;
  SunMarch march_;
};

Terrain::Terrain(Shared<const LitFunction> function) : Terrain(Shared<const Surface>(function)) {
  const FloatScope floats;
  lit_function_ = function.get();
}

Rgba8 sky_in(Rgba8 by_day, const Sun& sun) noexcept {
  constexpr double kDay = 30, kNight = -6, kLeast = 1.0 / 16;
  const double day = std::clamp((sun.elevation_deg - kNight) / (kDay - kNight), 0.0, 1.0);
  const double share = kLeast + (1 - kLeast) * day;
  const auto dim = [share](std::uint8_t v) {
    return static_cast<std::uint8_t>(std::lround(v * share));
  };
  return {dim(by_day.r), dim(by_day.g), dim(by_day.b), by_day.a};
}

Image<Rgba8> lit_colors(const HeightMap& map, const Light& light, const ShadowOptions& options) {
  const FloatScope floats;
  check(light);
  const Image<float> factor = light_of(map, light.hill_shading, light, options);
  const Image<Rgba8> by_height =
      map.colors.empty() ? colors_by_height(map.heights.view()) : Image<Rgba8>();
  const Image<Rgba8>& colors = map.colors.empty() ? by_height : map.colors;
  return under_light(colors, factor, light.smooth, options.tiling, lit, nullptr);
}

Terrain function_terrain(HeightFunction function, double low, double high, const Light& light,
                         std::optional<ScalarColors> colors) {
  const FloatScope floats;
  if (!function) reject("a terrain of a function needs one");
  check(light);
  if (!std::isfinite(light.sun.azimuth_deg) || !std::isfinite(light.sun.elevation_deg))
    reject("the sun's angles must be finite");
  return Terrain(Shared<const LitFunction>(std::make_unique<const LitFunction>(
      std::move(function), low, high, light, std::move(colors))));
}

std::optional<FunctionView> function_view(const Terrain& terrain) {
  const LitFunction* const function = terrain.lit_function();
  return function == nullptr ? std::nullopt : function->view();
}

}  // namespace rastrum::terrain
