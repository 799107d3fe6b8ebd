// Where the sun does not reach a height map, on a CUDA device: the definitions of shadows.hpp, a
// thread a cell.
//
// Sharp shadows. The sweep of the CPU (shadow_sweep.hpp) runs through a map column by column; a GPU
// wants rays that do not wait for each other. Each walks its list of cells as the definition does,
// but takes 2^l of them at once where the maxima of cells of 2^l × 2^l show that none of them is
// higher than the ray is where it enters the first: the ray climbs, so none of them hides the sun.
// It goes up a level where that was so and down one where not, and decides at level 0, by the
// comparison of the definition. (Tevs, Ihrke and Seidel, "Maximum mipmaps for fast, accurate, and
// scalable dynamic height field rendering", 2008, for rays of their own each.)
// Work O(cells · log(steps)) where most is skipped, O(cells · steps) at worst. Takes 7/3 of the
// map's bytes. Waits.
//
// The march: work O(cells · steps). Takes the map's bytes. Waits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/terrain/cuda/map.cuh>
#include <rastrum/terrain/shadow_kernels.hpp>
#include <rastrum/terrain/shadow_ray.hpp>

namespace rastrum::terrain {
namespace cuda_detail {

inline constexpr float kHole = -std::numeric_limits<float>::infinity();

/// A height as rays see it.
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

/// A sun below the horizon: everything but holes is dark.
struct IsNoHole {
  std::span<const float> cells;
  RASTRUM_HD std::uint8_t operator()(std::size_t i) const { return cells[i] == kHole ? 0 : 1; }
};
struct IsLit {
  RASTRUM_HD std::uint8_t operator()(std::size_t) const { return 0; }
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

/// sharp_shadows of a map on the device, row by row without gaps.
[[nodiscard]] inline parallel::DeviceBuffer<std::uint8_t> sharp_shadows(
    parallel::Cuda& exec, ImageView<const float> heights, const Sun& sun, Tiling tiling) {
  using namespace cuda_detail;
  const std::size_t cells =
      static_cast<std::size_t>(heights.width) * static_cast<std::size_t>(heights.height);
  DeviceLevels<float> levels(heights);
  levels.append(exec, 1, WithoutHole{heights});
  const std::span<const float> map(levels.last().data, cells);
  while (!levels.is_one_cell()) levels.append(exec, 2, HighestCell{levels.last(), 2});
  levels.finish(exec);
  auto shadow = parallel::make_buffer<std::uint8_t>(exec, cells);
  const float highest = parallel::to_host(exec, std::span(levels.last().data, 1))[0];
  const float lowest = parallel::reduce(exec, parallel::Computed(cells, HeightOrNone{map}),
                                        std::numeric_limits<float>::infinity(), Lower{});
  const double relief = static_cast<double>(highest) - static_cast<double>(lowest);
  std::vector<RayStep> steps;
  if (relief > 0 && sun.elevation_deg > 0) steps = ray_steps(sun_ray(sun, relief), relief);
  if (lowest <= highest && !(sun.elevation_deg > 0)) {
    parallel::tabulate(exec, shadow, IsNoHole{map});
  } else if (steps.empty()) {
    parallel::tabulate(exec, shadow, IsLit{});
  } else {
    const auto on_device = parallel::upload(exec, steps);
    const IsInShadow dark{{levels.list(1), heights.width, heights.height, 0},
                          tiling,
                          {on_device.data(), on_device.size()}};
    parallel::tabulate(exec, shadow, CellOfIndex<IsInShadow>{dark, heights.width});
  }
  exec.wait();
  return shadow;
}

/// hidden_samples of a map on the device, row by row without gaps.
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
