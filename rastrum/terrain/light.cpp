#include <rastrum/terrain_light.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain/function_light.hpp>

namespace rastrum::terrain {
namespace {

void check(const Light& light) {
  check_enum(light.shadows, Shadows::soft, "the kind of shadows");
  if (!(light.ambient >= 0 && light.ambient <= 1))
    throw Error(Errc::invalid_argument, "the ambient light must lie in 0 to 1");
}

/// What a cell shows of its colour.
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
    // A shadow leaves the ambient light; on a slope that is all there is already.
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

/// What a cell of a scaled image is made of along one axis: cells `a` and `b`, `share` of `b`.
struct Tap {
  int a = 0, b = 0;
  float share = 0;
};

/// The cells of an axis that is scaled from `from` to `to` cells: the cell that each lies in, or
/// what lies between centres.
std::vector<Tap> scaled_taps(int from, int to, bool smooth, Tiling tiling) {
  std::vector<Tap> taps(static_cast<std::size_t>(to));
  for (std::int64_t i = 0; i < to; ++i) {
    Tap& tap = taps[static_cast<std::size_t>(i)];
    // The centre in cells of `from`, less one half, times 2 · to: exact, so that equal sizes stay.
    const std::int64_t at = (2 * i + 1) * from - to, unit = std::int64_t{2} * to;
    const std::int64_t below = (at + unit) / unit - 1;  // at > −unit: the floor
    if (smooth) {
      tap = {static_cast<int>(tiled(below, from, tiling)),
             static_cast<int>(tiled(below + 1, from, tiling)),
             static_cast<float>(at - below * unit) / static_cast<float>(unit)};
    } else {
      tap.a = tap.b = static_cast<int>(i * from / to);
    }
  }
  return taps;
}

float mix(float a, float b, float share) {
  return a + share * (b - a);
}
Rgba8 mix(Rgba8 a, Rgba8 b, float share) {
  const auto channel = [share](std::uint8_t u, std::uint8_t v) {
    return static_cast<std::uint8_t>(mix(static_cast<float>(u), static_cast<float>(v), share) +
                                     0.5F);
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b), channel(a.a, b.a)};
}

template <class T>
T between(const Image<T>& image, const Tap& x, const Tap& y) {
  if (x.share == 0 && y.share == 0) return image(x.a, y.a);
  return mix(mix(image(x.a, y.a), image(x.b, y.a), x.share),
             mix(image(x.a, y.b), image(x.b, y.b), x.share), y.share);
}

}  // namespace

class LitFunction final : public Surface {
 public:
  LitFunction(HeightFunction function, double low, double high, const Light& light)
      : function_(std::move(function)),
        light_{low,
               high > low ? 1 / (high - low) : 0,
               light.hill_shading,
               light.shadows,
               light.ambient,
               ToSun::of(light.sun)} {
    if (light.shadows == Shadows::none) return;
    const auto azimuth = elementary::sin_cos(light.sun.azimuth_deg * (std::numbers::pi / 180));
    const auto elevation = elementary::sin_cos(light.sun.elevation_deg * (std::numbers::pi / 180));
    for (int k = 1; k < light.march.steps; ++k) {
      const double t = light.march.distance * k / light.march.steps;
      steps_.push_back(
          {t * azimuth.sin * elevation.cos, -t * azimuth.cos * elevation.cos, t * elevation.sin});
    }
  }

  void heights(const double* x, const double* y, std::size_t n, float* out) const override {
    function_(x, y, n, out);
  }

  void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const override {
    for (std::size_t i = 0; i < n; ++i) out[i] = color(x[i], y[i]);
  }

  [[nodiscard]] std::optional<FunctionView> view() const {
    const auto* const named = function_.target<NamedHeights>();
    return named == nullptr ? std::nullopt
                            : std::optional(FunctionView{named->function, light_, steps_});
  }

 private:
  [[nodiscard]] Rgba8 color(double x, double y) const {
    const std::array<double, 5> xs{x, x - kSlopeStep, x + kSlopeStep, x, x};
    const std::array<double, 5> ys{y, y, y, y - kSlopeStep, y + kSlopeStep};
    std::array<float, 5> h{};
    function_(xs.data(), ys.data(), h.size(), h.data());
    const float factor = light_.slope(h[1], h[2], h[3], h[4]);
    return light_.color(h[0], light_.shadowed(factor, hidden_samples(x, y, h[0])));
  }

  [[nodiscard]] int hidden_samples(double x, double y, float own) const {
    constexpr std::size_t kBatch = 64;
    std::array<double, kBatch> xs{}, ys{};
    std::array<float, kBatch> h{};
    int hidden = 0;
    for (std::size_t at = 0; at < steps_.size(); at += kBatch) {
      const std::size_t n = std::min(kBatch, steps_.size() - at);
      for (std::size_t k = 0; k < n; ++k) {
        xs[k] = x + steps_[at + k].x;
        ys[k] = y + steps_[at + k].y;
      }
      function_(xs.data(), ys.data(), n, h.data());
      for (std::size_t k = 0; k < n; ++k)
        hidden += FunctionLight::hides(h[k], own, steps_[at + k]) ? 1 : 0;
      if (light_.shadows == Shadows::sharp && hidden != 0) break;
    }
    return hidden;
  }

  HeightFunction function_;
  FunctionLight light_;
  std::vector<FunctionStep> steps_;
};

Terrain::Terrain(std::shared_ptr<const LitFunction> function)
    : Terrain(std::shared_ptr<const Surface>(function)) {
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
  check(light);
  const Image<float> factor = light_of(map, light.hill_shading, light, options);
  const Image<Rgba8> by_height =
      map.colors.empty() ? colors_by_height(map.heights.view()) : Image<Rgba8>();
  const Image<Rgba8>& colors = map.colors.empty() ? by_height : map.colors;
  Image<Rgba8> out(std::max(colors.width(), factor.width()),
                   std::max(colors.height(), factor.height()));
  const auto taps = [&](int from, int to) {
    return scaled_taps(from, to, light.smooth, options.tiling);
  };
  const std::vector<Tap> color_x = taps(colors.width(), out.width()),
                         color_y = taps(colors.height(), out.height()),
                         light_x = taps(factor.width(), out.width()),
                         light_y = taps(factor.height(), out.height());
  for (int y = 0; y < out.height(); ++y) {
    const auto row = static_cast<std::size_t>(y);
    for (int x = 0; x < out.width(); ++x) {
      const auto column = static_cast<std::size_t>(x);
      out(x, y) = lit(between(colors, color_x[column], color_y[row]),
                      between(factor, light_x[column], light_y[row]));
    }
  }
  return out;
}

Terrain function_terrain(HeightFunction function, double low, double high, const Light& light) {
  check(light);
  if (!std::isfinite(light.sun.azimuth_deg) || !std::isfinite(light.sun.elevation_deg))
    throw Error(Errc::invalid_argument, "the sun's angles must be finite");
  return Terrain(std::make_shared<const LitFunction>(std::move(function), low, high, light));
}

std::optional<FunctionView> function_view(const Terrain& terrain) {
  const LitFunction* const function = terrain.lit_function();
  return function == nullptr ? std::nullopt : function->view();
}

}  // namespace rastrum::terrain
