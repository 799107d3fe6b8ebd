// SPDX-License-Identifier: BSD-3-Clause
// Ground under the lights of meshes, lit as a matt surface at each cell or point
// (lights_scalar.hpp). The terrain's own functions find the shadows of directional lights.
#include <rastrum/on_terrain.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/lights_scalar.hpp>
#include <rastrum/render/terrain_camera.hpp>
#include <rastrum/render/tone_pass.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain/function_light.hpp>
#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/sun_march.hpp>
#include <rastrum/terrain/under_light.hpp>

namespace rastrum {
namespace {

using terrain::Slopes;
using terrain::Sun;
using terrain::SunMarch;

void check_ground(const GroundLights& ground) {
  check_lights(ground.lights);
  check_enum(ground.shadows, terrain::Shadows::soft, "the kind of shadows");
  check_tone(ground.tone);
}

/// Exact on axes and diagonals, like directions of sweeps.
Sun sun_of(Vec3 to_light) {
  const double east = to_light.x, up = to_light.y, north = -static_cast<double>(to_light.z);
  const double a = std::abs(east), b = std::abs(north), most = std::max(a, b);
  constexpr double kDegrees = 180 / std::numbers::pi;
  if (most == 0) return {0, up > 0 ? 90.0 : -90.0};
  const double least = std::min(a, b);
  const double within = a == b ? 45 : elementary::atan(least / most) * kDegrees;
  const double quarter = a <= b ? within : 90 - within;  // from the north or south
  const double half = north >= 0 ? quarter : 180 - quarter;
  const double flat = std::sqrt(east * east + north * north);
  return {east >= 0 ? half : 360 - half, std::min(elementary::atan(up / flat) * kDegrees, 90.0)};
}

Vec3 ground_normal(Vec2 slope) {
  const float scale = 1 / std::sqrt(1 + slope.x * slope.x + slope.y * slope.y);
  return {-slope.x * scale, scale, -slope.y * scale};
}

class LightsOnGround {
 public:
  explicit LightsOnGround(const GroundLights& ground)
      : lights_(ground.lights),
        camera_(camera_for(ground)),
        set_(lights_, {}, camera_, 1, 1),
        maps_light_(ground.tone != ToneMapping{}),
        curve_(ground.tone) {
    for (const raster::LightTerm& term : set_.set().terms) {
      const bool casts = ground.shadows != terrain::Shadows::none &&
                         term.kind == raster::LightTerm::Kind::directional;
      suns_.push_back(casts ? std::optional(sun_of(term.place)) : std::nullopt);
    }
  }
  LightsOnGround(const LightsOnGround&) = delete;
  LightsOnGround& operator=(const LightsOnGround&) = delete;

  /// One for each light with a place or direction; none where it casts no shadows.
  [[nodiscard]] const std::vector<std::optional<Sun>>& suns() const { return suns_; }

  /// The light that a white, matt surface reflects at (x, height, y), where it rises by `slope`.
  /// `share(i)`: how much of light i arrives.
  template <class Share>
  [[nodiscard]] Vec3 at(double x, double y, float height, Vec2 slope, const Share& share) const {
    const raster::LightSet& set = set_.set();
    const Vec3 n = ground_normal(slope);
    const Vec3 place(Vec3d{x, static_cast<double>(height), y} - camera_.eye);
    Vec3 sum = raster::scalar_lane::gathered(set, n);
    for (std::size_t i = 0; i < set.terms.size(); ++i) {
      const auto in = raster::scalar_lane::incoming(set.terms[i], place);
      const float n_l = dot(n, in.to_light);
      if (n_l > 0) sum = sum + in.radiance * (n_l * share(i));
    }
    return sum;
  }

  [[nodiscard]] Rgba8 lit(Rgba8 color, Vec3 light) const {
    if (!maps_light_) {
      const Vec4 c = raster::straight_from_rgba8(color);
      return opaque({c.x * light.x, c.y * light.y, c.z * light.z});
    }
    const auto& linear = raster::decode_tables().srgb;
    return opaque(
        curve_({linear[color.r] * light.x, linear[color.g] * light.y, linear[color.b] * light.z}));
  }

 private:
  /// Places are relative to this camera, on which results must not depend without lights of the
  /// camera.
  static Camera camera_for(const GroundLights& ground) {
    if (is_of_camera(ground.lights)) return terrain_camera(ground.camera);
    Camera corner;
    corner.eye = {0, 0, 0};
    corner.target = {0, 0, -1};
    return corner;
  }
  static Rgba8 opaque(Vec3 c) {
    return {raster::quantize(c.x), raster::quantize(c.y), raster::quantize(c.z), 255};
  }

  std::vector<Light> lights_;
  Camera camera_;
  raster::FrameLights set_;
  bool maps_light_;
  ToneCurve curve_;
  std::vector<std::optional<Sun>> suns_;
};

Image<float> share_of(ImageView<const float> heights, const Sun& sun, const GroundLights& ground,
                      const terrain::ShadowOptions& options) {
  Image<float> share(heights.width, heights.height);
  const auto fill = [&](const auto& from, const auto& of) {
    for (std::size_t i = 0; i < share.pixels().size(); ++i)
      share.pixels()[i] = of(from.pixels()[i]);
  };
  if (ground.shadows == terrain::Shadows::accumulated)
    fill(terrain::hidden_samples(heights, sun, ground.march, options),
         [](std::uint16_t n) { return std::sqrt(1 / (1 + static_cast<float>(n))); });
  else if (ground.shadows == terrain::Shadows::sharp)
    fill(terrain::sharp_shadows(heights, sun, options),
         [](std::uint8_t dark) { return dark != 0 ? 0.0F : 1.0F; });
  else
    fill(terrain::soft_light(heights, sun, ground.sun_radius_deg, options),
         [](std::uint8_t seen) { return static_cast<float>(seen) / 255; });
  return share;
}

/// The terrain of a function, lit at the points where it is sampled.
class FunctionUnderLights final : public terrain::Surface {
 public:
  FunctionUnderLights(terrain::HeightFunction function, double low, double high,
                      const GroundLights& ground, std::optional<ScalarColors> colors)
      : function_(std::move(function)),
        low_(low),
        scale_(high > low ? 1 / (high - low) : 0),
        colors_(std::move(colors)),
        lights_(ground) {
    shadow_.shadows = ground.shadows;
    shadow_.ambient = 0;
    for (const std::optional<Sun>& sun : lights_.suns())
      marches_.push_back(sun ? SunMarch(*sun, ground.march) : SunMarch());
  }

  void heights(const double* x, const double* y, std::size_t n, float* out) const override {
    function_(x, y, n, out);
  }
  void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const override {
    for (std::size_t i = 0; i < n; ++i) out[i] = color(x[i], y[i]);
  }

 private:
  [[nodiscard]] Rgba8 color(double x, double y) const {
    constexpr double kStep = terrain::kSlopeStep;
    const std::array<double, 5> xs{x, x - kStep, x + kStep, x, x};
    const std::array<double, 5> ys{y, y, y, y - kStep, y + kStep};
    std::array<float, 5> h{};
    function_(xs.data(), ys.data(), h.size(), h.data());
    constexpr auto kAcross = static_cast<float>(2 * kStep);
    const Vec2 slope{(h[2] - h[1]) / kAcross, (h[4] - h[3]) / kAcross};
    const auto share = [&](std::size_t i) {
      if (marches_[i].steps().empty()) return 1.0F;
      const bool one_is_enough = shadow_.shadows == terrain::Shadows::sharp;
      return shadow_.shadowed(1, marches_[i].hidden(function_, x, y, h[0], one_is_enough));
    };
    const auto height = static_cast<double>(h[0]);
    const Rgba8 base = colors_ ? terrain::shown((*colors_)(height))
                               : terrain::height_color((height - low_) * scale_);
    return lights_.lit(base, lights_.at(x, y, h[0], slope, share));
  }

  terrain::HeightFunction function_;
  double low_, scale_;
  std::optional<ScalarColors> colors_;
  LightsOnGround lights_;
  terrain::FunctionLight shadow_;
  std::vector<SunMarch> marches_;  ///< one a light
};

}  // namespace

Image<Rgba8> lit_colors(const terrain::HeightMap& map, const GroundLights& ground,
                        const terrain::ShadowOptions& options) {
  const FloatScope floats;
  check_ground(ground);
  const ImageView<const float> heights = map.heights.view();
  if (heights.empty()) reject("the height map has no cell; give it at least one");
  const LightsOnGround lights(ground);
  std::vector<Image<float>> shares;
  for (const std::optional<Sun>& sun : lights.suns())
    shares.push_back(sun ? share_of(heights, *sun, ground, options) : Image<float>());
  std::unique_ptr<parallel::Threads> threads;
  if (options.device != Device::serial)
    threads = std::make_unique<parallel::Threads>(options.threads);
  const Slopes slopes{heights, options.tiling};
  Image<Vec3> light(heights.width, heights.height);
  const auto light_row = [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < heights.width; ++x) {
      const float height = heights(x, y);
      if (!std::isfinite(height)) continue;
      const auto share = [&](std::size_t i) { return shares[i].empty() ? 1.0F : shares[i](x, y); };
      light(x, y) = lights.at(x + 0.5, y + 0.5, height, slopes.at(x, y), share);
    }
  };
  parallel::for_each_index(threads.get(), static_cast<std::size_t>(heights.height), light_row, 8);
  const Image<Rgba8> by_height =
      map.colors.empty() ? terrain::colors_by_height(heights) : Image<Rgba8>();
  return terrain::under_light(
      map.colors.empty() ? by_height : map.colors, light, ground.smooth, options.tiling,
      [&](Rgba8 color, Vec3 of) { return lights.lit(color, of); }, threads.get());
}

terrain::Terrain function_terrain(terrain::HeightFunction function, double low, double high,
                                  const GroundLights& ground, std::optional<ScalarColors> colors) {
  const FloatScope floats;
  check_ground(ground);
  if (ground.shadows != terrain::Shadows::none) terrain::check(ground.march);
  return terrain::Terrain(
      Shared<const terrain::Surface>(std::make_unique<const FunctionUnderLights>(
          std::move(function), low, high, ground, std::move(colors))));
}

}  // namespace rastrum
