// SPDX-License-Identifier: BSD-3-Clause
// The functions of terrain_light.hpp. Plain loops, for `serial` and the scalar instruction set, are
// the definition; others use shadows_simd.cpp.
#include <rastrum/core/elementary.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/terrain_light.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain/cuda/device.hpp>
#include <rastrum/terrain/shadow_kernels.hpp>
#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain/shadow_reach.hpp>
#include <rastrum/terrain/shadow_sweep.hpp>

namespace rastrum::terrain {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// At multiples of 45° both are exactly 0, ±1 or of equal size.
std::pair<double, double> sin_cos_deg(double degrees) {
  const double turn = std::fmod(degrees, 360.0);
  const double octant = std::round(turn / 45.0);
  const double rest = (turn - octant * 45.0) * (std::numbers::pi / 180);
  const auto [s, c] = elementary::sin_cos(rest);
  constexpr double kHalf = std::numbers::sqrt2 / 2;
  const double diagonal_s = kHalf * (s + c), diagonal_c = kHalf * (c - s);
  switch ((static_cast<int>(octant) % 8 + 8) % 8) {
    case 0:
      return {s, c};
    case 1:
      return {diagonal_s, diagonal_c};
    case 2:
      return {c, -s};
    case 3:
      return {diagonal_c, -diagonal_s};
    case 4:
      return {-s, -c};
    case 5:
      return {-diagonal_s, -diagonal_c};
    case 6:
      return {-c, s};
    default:
      return {-diagonal_c, diagonal_s};
  }
}

void check(const Sun& sun) {
  if (!std::isfinite(sun.azimuth_deg) || !std::isfinite(sun.elevation_deg) ||
      sun.elevation_deg > 90)
    reject("the sun's angles must be finite, and its elevation at most 90 degrees");
}

/// The result of f if the options choose a CUDA device; none also for `automatic` if the device's
/// memory is too small.
template <class F>
auto on_cuda(const ShadowOptions& options, F&& f) -> std::optional<decltype(f())> {
  if (choose_device(options.device).device != Device::cuda) return std::nullopt;
  try {
    return f();
  } catch (const Error& e) {
    if (options.device != Device::automatic || e.code() != Errc::out_of_memory) throw;
    return std::nullopt;
  }
}

/// Null means the caller's thread alone.
std::unique_ptr<parallel::Threads> threads_of(const ShadowOptions& options) {
  return options.device == Device::serial ? nullptr
                                          : std::make_unique<parallel::Threads>(options.threads);
}

Isa isa_of(const ShadowOptions& options) {
  const Isa chosen = choose_isa(options.isa);
  return options.device == Device::serial ? Isa::scalar : chosen;
}

bool plain_tile_ranges(const float* heights, std::ptrdiff_t stride, int rows, std::size_t width,
                       float* lowest, float* highest) noexcept {
  const std::size_t tiles = (width + HeightTiles::kEdge - 1) / HeightTiles::kEdge;
  std::fill_n(lowest, tiles, kInfinity);
  std::fill_n(highest, tiles, -kInfinity);
  bool finite = true;
  for (int row = 0; row < rows; ++row, heights += stride)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t tile = x / HeightTiles::kEdge;
      finite = finite && std::isfinite(heights[x]);
      lowest[tile] = std::min(lowest[tile], heights[x]);
      highest[tile] = std::max(highest[tile], heights[x]);
    }
  return finite;
}

/// Returns whether all heights are finite.
bool find_tiles(ImageView<const float> heights, const ShadowKernels& kernels, HeightTiles& tiles) {
  const auto ranges = kernels.tile_ranges != nullptr ? kernels.tile_ranges : plain_tile_ranges;
  tiles.resize(heights.width, heights.height);
  bool finite = true;
  for (int row = 0; row < tiles.down; ++row) {
    const int y = row * HeightTiles::kEdge;
    const std::size_t first = tiles.at(0, row);
    finite =
        ranges(heights.row(y), heights.stride, std::min(HeightTiles::kEdge, heights.height - y),
               static_cast<std::size_t>(heights.width), &tiles.lowest[first],
               &tiles.highest[first]) &&
        finite;
  }
  return finite;
}

/// Holes become −inf, in `copy`.
ShadowCaster caster_of(ImageView<const float> heights, Tiling tiling, const ShadowKernels& kernels,
                       Image<float>& copy, HeightTiles& tiles) {
  ShadowCaster map{heights, tiling, kInfinity, -kInfinity};
  if (find_tiles(heights, kernels, tiles)) {
    map.lowest = *std::ranges::min_element(tiles.lowest);
    map.highest = *std::ranges::max_element(tiles.highest);
    return map;
  }
  copy = Image<float>(heights.width, heights.height);
  map.heights = copy.view();
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x) {
      const float h = heights(x, y);
      const bool hole = !std::isfinite(h);
      copy(x, y) = hole ? -kInfinity : h;
      if (hole) continue;
      map.lowest = std::min(map.lowest, h);
      map.highest = std::max(map.highest, h);
    }
  find_tiles(map.heights, kernels, tiles);
  return map;
}

/// Shades a map with nothing beyond it: with a ring of holes around it and Tiling::clamp.
template <class Shade>
auto shade_alone(ImageView<const float> heights, ShadowOptions options, const Shade& shade) {
  Image<float> ringed(heights.width + 2, heights.height + 2);
  std::ranges::fill(ringed.pixels(), -kInfinity);
  for (int y = 0; y < heights.height; ++y)
    std::copy_n(heights.row(y), heights.width, &ringed(1, y + 1));
  options.tiling = Tiling::clamp;
  const auto shaded = shade(ringed.view(), options);
  std::remove_const_t<decltype(shaded)> made(heights.width, heights.height);
  for (int y = 0; y < heights.height; ++y)
    std::copy_n(&shaded(1, y + 1), heights.width, &made(0, y));
  return made;
}

constexpr std::size_t kRowGrain = 8;
/// With so many bands a thread's block of cells stays in the first-level cache.
constexpr int kBandGrain = 512;

/// Vogel's spiral: equal areas, the golden angle apart.
std::vector<Sun> points_of_disc(const Sun& sun, double radius_deg) {
  constexpr int kPoints = 16;
  std::vector<Sun> points;
  for (int i = 0; i < kPoints; ++i) {
    const double r = radius_deg * std::sqrt((i + 0.5) / kPoints);
    const auto [sin, cos] = elementary::sin_cos(i * std::numbers::pi * (3 - std::sqrt(5.0)));
    const double elevation = sun.elevation_deg + r * sin;
    // A degree of azimuth is cos(elevation) degrees long across the sky.
    const double across = elementary::cos(sun.elevation_deg * std::numbers::pi / 180);
    const double turn = std::min(180.0, std::abs(r * cos) / std::max(across, 1e-9));
    Sun point{sun.azimuth_deg + std::copysign(turn, cos), elevation};
    if (elevation > 90) point = {point.azimuth_deg + 180, 180 - elevation};
    check(point);
    points.push_back(point);
  }
  return points;
}

}  // namespace

SunRay sun_ray(const Sun& sun) {
  check(sun);
  const auto [east, north] = sin_cos_deg(sun.azimuth_deg);
  const auto [up, flat] = sin_cos_deg(sun.elevation_deg);
  return {east, -north, up / std::abs(flat)};  // no −0 at the zenith
}

SunRay sun_ray(const Sun& sun, double relief) {
  SunRay ray = sun_ray(sun);
  const double along = std::max(std::abs(ray.x), std::abs(ray.y));
  ray.rise = std::max(ray.rise, relief * along / kLongestShadow);
  return ray;
}

std::vector<RayStep> ray_steps(const SunRay& ray, double relief) {
  // Crossings nearer to each other than this share of the way are one: a corner.
  constexpr double kCorner = 1e-9;
  const double per_x = 1 / std::abs(ray.x), per_y = 1 / std::abs(ray.y);
  const int sx = ray.x < 0 ? -1 : 1, sy = ray.y < 0 ? -1 : 1;
  std::vector<RayStep> steps;
  std::int32_t nx = 0, ny = 0;  // borders crossed
  for (;;) {
    const double tx = ray.x == 0 ? std::numeric_limits<double>::infinity() : (nx + 0.5) * per_x;
    const double ty = ray.y == 0 ? std::numeric_limits<double>::infinity() : (ny + 0.5) * per_y;
    const double t = std::min(tx, ty);
    if (!(t * ray.rise <= relief)) return steps;
    const bool corner = std::abs(tx - ty) <= kCorner * t;
    if (tx <= ty || corner) ++nx;
    if (ty <= tx || corner) ++ny;
    // The ray enters the next cell at the later of the two crossings.
    steps.push_back({sx * nx, sy * ny, (corner ? std::max(tx, ty) : t) * ray.rise});
  }
}

Image<std::uint8_t> sharp_shadows(ImageView<const float> heights, const Sun& sun,
                                  const ShadowOptions& options) {
  const FloatScope floats;
  if (options.tiling == Tiling::none)
    return shade_alone(heights, options,
                       [&](const auto& h, const auto& o) { return sharp_shadows(h, sun, o); });
  check_stride(heights, "the height map");
  check(sun);
  const Isa isa = isa_of(options);
  if (const auto dark =
          on_cuda(options, [&] { return sharp_shadows_on_device(heights, sun, options.tiling); }))
    return *dark;
  Image<std::uint8_t> shadow(heights.width, heights.height);
  const ShadowKernels& kernels = shadow_kernels(isa);
  Image<float> copy;
  HeightTiles tiles;
  const ShadowCaster map = caster_of(heights, options.tiling, kernels, copy, tiles);
  if (!(map.lowest <= map.highest)) return shadow;  // only holes
  const SunRay ray = sun_ray(sun, map.relief());
  std::vector<RayStep> steps;
  if (sun.elevation_deg > 0 && map.relief() > 0) steps = ray_steps(ray, map.relief());
  const SweepKernel kernel = can_sweep(map) ? sweep_kernel(isa) : nullptr;
  if (!(sun.elevation_deg > 0)) {
    std::ranges::fill(shadow.pixels(), std::uint8_t{1});
  } else if (steps.empty()) {
    return shadow;
  } else if (kernel == nullptr) {
    const auto row = [&](std::size_t number) {
      const int y = static_cast<int>(number);
      for (int x = 0; x < heights.width; ++x) shadow(x, y) = in_shadow(map, steps, x, y) ? 1 : 0;
    };
    parallel::for_each_index(threads_of(options).get(), static_cast<std::size_t>(heights.height),
                             row);
  } else {
    const Sweep sweep = plan_sweep(map, tiles, ray, std::move(steps));
    const int parts = (sweep.bands + kBandGrain - 1) / kBandGrain;
    const auto sweep_part = [&](std::size_t part) {
      const int first = static_cast<int>(part) * kBandGrain;
      kernel(sweep, first, std::min(first + kBandGrain, sweep.bands), shadow.view());
    };
    parallel::for_each_index(threads_of(options).get(), static_cast<std::size_t>(parts),
                             sweep_part);
  }
  for (std::size_t i = 0; i < copy.pixels().size(); ++i)
    if (copy.pixels()[i] == -kInfinity) shadow.pixels()[i] = 0;
  return shadow;
}

Image<std::uint8_t> soft_light(ImageView<const float> heights, const Sun& sun, double radius_deg,
                               const ShadowOptions& options) {
  const FloatScope floats;
  if (options.tiling == Tiling::none)
    return shade_alone(heights, options, [&](const auto& h, const auto& o) {
      return soft_light(h, sun, radius_deg, o);
    });
  check_stride(heights, "the height map");
  check(sun);
  if (!(radius_deg >= 0 && radius_deg <= 45))
    reject("the sun's radius must lie in 0 to 45 degrees");
  const std::vector<Sun> points = points_of_disc(sun, radius_deg);
  if (const auto light = on_cuda(
          options, [&] { return light_of_suns_on_device(heights, points, options.tiling); }))
    return *light;
  Image<std::uint16_t> lit(heights.width, heights.height);
  for (const Sun& point : points) {
    const Image<std::uint8_t> shadow = sharp_shadows(heights, point, options);
    for (std::size_t k = 0; k < lit.pixels().size(); ++k)
      lit.pixels()[k] = static_cast<std::uint16_t>(lit.pixels()[k] + 1 - shadow.pixels()[k]);
  }
  Image<std::uint8_t> light(heights.width, heights.height);
  for (std::size_t k = 0; k < lit.pixels().size(); ++k)
    light.pixels()[k] = part_of_suns(lit.pixels()[k], static_cast<std::uint32_t>(points.size()));
  return light;
}

void check(const March& march) {
  if (!(march.distance > 0 && march.distance <= kLongestShadow) || march.steps < 2 ||
      march.steps > 65536)
    reject("a march must be above 0 to 65536 cells long and have 2 to 65536 steps");
}

std::vector<MarchSample> march_samples(const Sun& sun, const March& march) {
  check(sun);
  check(march);
  const auto [east, north] = sin_cos_deg(sun.azimuth_deg);
  const auto [up, flat] = sin_cos_deg(sun.elevation_deg);
  std::vector<MarchSample> samples;
  for (int k = 1; k < march.steps; ++k) {
    const double t = march.distance * k / march.steps;
    samples.push_back({static_cast<std::int32_t>(std::floor(t * east * flat)),
                       static_cast<std::int32_t>(std::floor(t * -north * flat)),
                       static_cast<float>(t * up)});
  }
  return samples;
}

Image<std::uint16_t> hidden_samples(ImageView<const float> heights, const Sun& sun,
                                    const March& march, const ShadowOptions& options) {
  const FloatScope floats;
  if (options.tiling == Tiling::none)
    return shade_alone(heights, options, [&](const auto& h, const auto& o) {
      return hidden_samples(h, sun, march, o);
    });
  check_stride(heights, "the height map");
  const std::vector<MarchSample> samples = march_samples(sun, march);
  const ShadowKernels& kernels = shadow_kernels(isa_of(options));
  if (const auto hidden = on_cuda(
          options, [&] { return hidden_samples_on_device(heights, sun, march, options.tiling); }))
    return *hidden;
  Image<float> copy;
  HeightTiles tiles;
  const ShadowCaster map = caster_of(heights, options.tiling, kernels, copy, tiles);
  Image<std::uint16_t> counts(heights.width, heights.height);
  const auto row = [&](std::size_t number) {
    const int y = static_cast<int>(number);
    if (kernels.march_row != nullptr) return kernels.march_row(map, samples, y, &counts(0, y));
    for (int x = 0; x < heights.width; ++x) counts(x, y) = hidden_count(map, samples, x, y);
  };
  parallel::for_each_index(threads_of(options).get(), static_cast<std::size_t>(heights.height), row,
                           kRowGrain);
  return counts;
}

}  // namespace rastrum::terrain
