// SPDX-License-Identifier: BSD-3-Clause
// The shadows of a height map on a CUDA device, one thread per cell: the definitions of
// shadows.hpp.
//
// Sharp shadows. The CPU's sweep (shadow_sweep.hpp) runs column by column; a GPU needs rays that do
// not wait for each other. Each ray walks its list of cells as the definition does, but takes 2^l
// of them at once if the maxima of 2^l × 2^l cells show that none is higher than the ray at its
// entry into the first. The ray climbs, so none of them hides the sun. After such a step it goes up
// a level, else down one, and decides at level 0 by the definition's comparison. (Tevs, Ihrke and
// Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field rendering", 2008,
// where each ray differs.) Work O(cells · log(steps)) where most is skipped, O(cells · steps) at
// worst. Takes 7/3 of the map's bytes. Waits.
//
// The march: work O(cells · steps). Takes the map's bytes. Waits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/terrain/cuda/map.cuh>
#include <rastrum/terrain/shadow_kernels.hpp>
#include <rastrum/terrain/shadow_ray.hpp>
#include <rastrum/terrain_light.hpp>

namespace rastrum::terrain {
namespace cuda_detail {

inline constexpr float kHole = -std::numeric_limits<float>::infinity();

struct WithoutHole {
  ImageView<const float> heights;
  RASTRUM_HD float operator()(int x, int y) const {
    const float h = heights(x, y);
    return std::isfinite(h) ? h : kHole;
  }
};
struct HeightOrNone {
  std::span<const float> cells;
  RASTRUM_HD float operator()(std::size_t i) const {
    return cells[i] == kHole ? std::numeric_limits<float>::infinity() : cells[i];
  }
};
struct Lower {
  RASTRUM_HD float operator()(float a, float b) const { return b < a ? b : a; }
};

/// For a sun below the horizon.
struct IsNoHole {
  std::span<const float> cells;
  RASTRUM_HD std::uint8_t operator()(std::size_t i) const { return cells[i] == kHole ? 0 : 1; }
};
struct IsLit {
  RASTRUM_HD std::uint8_t operator()(std::size_t) const { return 0; }
};

/// Counts visible suns.
struct AddLit {
  const std::uint8_t* lit;
  const std::uint8_t* dark;
  RASTRUM_HD std::uint8_t operator()(std::size_t i) const {
    return static_cast<std::uint8_t>(lit[i] + 1 - dark[i]);
  }
};
struct PartOfSuns {
  const std::uint8_t* lit;
  std::uint32_t suns;
  RASTRUM_HD std::uint8_t operator()(std::size_t i) const { return part_of_suns(lit[i], suns); }
};

struct IsInShadow {
  CeilingView maxima;  ///< from the map itself on
  Tiling tiling;
  std::span<const RayStep> steps;

  RASTRUM_HD std::uint8_t operator()(int x, int y) const {
    const float height = maxima.levels[0](x, y);
    if (height == kHole) return 0;
    const auto own = static_cast<double>(height);
    const int top = static_cast<int>(maxima.levels.size()) - 1;
    const auto highest = static_cast<double>(maxima.levels[static_cast<std::size_t>(top)](0, 0));
    int level = 0;
    for (std::size_t k = 0; k < steps.size();) {
      const double ray = own + steps[k].climb;
      if (ray >= highest) return 0;
      std::size_t last = k + (std::size_t{1} << level) - 1;
      if (last >= steps.size()) last = steps.size() - 1;
      const float over = maxima.on_level(level, between(x, steps[k].dx, steps[last].dx),
                                         between(y, steps[k].dy, steps[last].dy), tiling);
      if (!(static_cast<double>(over) > ray)) {
        k = last + 1;
        if (level < top) ++level;
      } else if (level == 0) {
        return 1;
      } else {
        --level;
      }
    }
    return 0;
  }

 private:
  RASTRUM_HD static CellRange between(std::int64_t at, std::int32_t a, std::int32_t b) {
    return a < b ? CellRange{at + a, at + b} : CellRange{at + b, at + a};
  }
};

struct CountHidden {
  ShadowCaster map;
  std::span<const MarchSample> samples;
  RASTRUM_HD std::uint16_t operator()(int x, int y) const {
    return hidden_count(map, samples, x, y);
  }
};

}  // namespace cuda_detail
}  // namespace rastrum::terrain

namespace rastrum::parallel {
template <>
inline constexpr bool kAnyOrder<float, terrain::cuda_detail::Lower> = true;  // there is no NaN
}

namespace rastrum::terrain {

/// A map with the maxima by which rays skip parts of it. Takes 4/3 of the map's bytes.
class ShadowMap {
 public:
  /// `heights`, on the device, must outlive it. Waits.
  ShadowMap(parallel::Cuda& exec, ImageView<const float> heights, Tiling tiling)
      : levels_(heights), tiling_(tiling), width_(heights.width), height_(heights.height) {
    using namespace cuda_detail;
    levels_.append(exec, 1, WithoutHole{heights});
    map_ = {levels_.last().data,
            static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)};
    while (!levels_.is_one_cell()) levels_.append(exec, 2, HighestCell{levels_.last(), 2});
    levels_.finish(exec);
    highest_ = parallel::to_host(exec, std::span(levels_.last().data, 1))[0];
    lowest_ = parallel::reduce(exec, parallel::Computed(map_.size(), HeightOrNone{map_}),
                               std::numeric_limits<float>::infinity(), Lower{});
  }
  [[nodiscard]] std::size_t cells() const { return map_.size(); }

  /// Row by row without gaps. Waits.
  void sharp(parallel::Cuda& exec, const Sun& sun,
             parallel::DeviceBuffer<std::uint8_t>& shadow) const {
    using namespace cuda_detail;
    const double relief = static_cast<double>(highest_) - static_cast<double>(lowest_);
    std::vector<RayStep> steps;
    if (relief > 0 && sun.elevation_deg > 0) steps = ray_steps(sun_ray(sun, relief), relief);
    if (lowest_ <= highest_ && !(sun.elevation_deg > 0)) {
      parallel::tabulate(exec, shadow, IsNoHole{map_});
    } else if (steps.empty()) {
      parallel::tabulate(exec, shadow, IsLit{});
    } else {
      const auto on_device = parallel::upload(exec, steps);
      const IsInShadow dark{
          {levels_.list(1), width_, height_, 0}, tiling_, {on_device.data(), on_device.size()}};
      parallel::tabulate(exec, shadow, CellOfIndex<IsInShadow>{dark, width_});
    }
    exec.wait();
  }

 private:
  DeviceLevels<float> levels_;
  Tiling tiling_;
  int width_, height_;
  std::span<const float> map_;
  float highest_ = 0, lowest_ = 0;
};

/// For a map on the device, row by row without gaps.
[[nodiscard]] inline parallel::DeviceBuffer<std::uint8_t> sharp_shadows(
    parallel::Cuda& exec, ImageView<const float> heights, const Sun& sun, Tiling tiling) {
  const ShadowMap map(exec, heights, tiling);
  auto shadow = parallel::make_buffer<std::uint8_t>(exec, map.cells());
  map.sharp(exec, sun, shadow);
  return shadow;
}

/// The share of 255 that these suns of equal brightness give; fewer than 256 suns.
[[nodiscard]] inline parallel::DeviceBuffer<std::uint8_t> light_of_suns(
    parallel::Cuda& exec, ImageView<const float> heights, std::span<const Sun> suns,
    Tiling tiling) {
  const ShadowMap map(exec, heights, tiling);
  auto shadow = parallel::make_buffer<std::uint8_t>(exec, map.cells());
  auto light = parallel::make_buffer<std::uint8_t>(exec, map.cells());
  parallel::tabulate(exec, light, cuda_detail::IsLit{});
  for (const Sun& sun : suns) {
    map.sharp(exec, sun, shadow);
    parallel::tabulate(exec, light, cuda_detail::AddLit{light.data(), shadow.data()});
  }
  parallel::tabulate(
      exec, light, cuda_detail::PartOfSuns{light.data(), static_cast<std::uint32_t>(suns.size())});
  exec.wait();
  return light;
}

/// For a map on the device, row by row without gaps.
[[nodiscard]] inline parallel::DeviceBuffer<std::uint16_t> hidden_samples(
    parallel::Cuda& exec, ImageView<const float> heights, const Sun& sun, const March& march,
    Tiling tiling) {
  using namespace cuda_detail;
  const std::vector<MarchSample> samples = march_samples(sun, march);
  const auto on_device = parallel::upload(exec, samples);
  DeviceLevels<float> levels(heights);
  levels.append(exec, 1, WithoutHole{heights});
  auto counts = parallel::make_buffer<std::uint16_t>(
      exec, static_cast<std::size_t>(heights.width) * static_cast<std::size_t>(heights.height));
  const CountHidden hidden{{levels.last(), tiling}, {on_device.data(), on_device.size()}};
  parallel::tabulate(exec, counts, CellOfIndex<CountHidden>{hidden, heights.width});
  exec.wait();
  return counts;
}

}  // namespace rastrum::terrain
