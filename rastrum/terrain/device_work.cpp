// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain/device_work.hpp>

#include <algorithm>

#include <rastrum/core/number_text.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace {

// Times of one thread, per slice of a column and per pixel: within a third of docs/log/terrain.md's
// table from 800×450 to 3840×2160.
constexpr double kHostSlice_ns = 0.4, kHostPixel_ns = 0.7;
// Guessed for an A100: eight bytes per slice and pixel at 1.5 TB/s.
constexpr double kDeviceSlice_ns = 0.005, kDevicePixel_ns = 0.005;
constexpr std::uint64_t kLaunches = 8;
/// Frames that share one copy of a map: fewer than a flight has, but more than one.
constexpr std::uint64_t kFramesOfMap = 16;

}  // namespace

std::uint64_t map_bytes(const Terrain& terrain) {
  if (!terrain.is_map()) return 0;
  return terrain.heights()->pixels().size_bytes() + terrain.colors()->pixels().size_bytes();
}

FrameWork device_work(const Terrain& map, const TerrainOptions& options,
                      const TerrainTargets& targets) {
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height);
  // A slice of a function costs more than one of a map; how much more is not known.
  const double slices = std::min(slice_count(options), static_cast<double>(kMaxSlices)) *
                        static_cast<double>(options.width);
  const auto p = static_cast<double>(pixels);
  FrameWork work;
  work.what = text_of(options.width, "x", options.height, " pixels of terrain, ",
                      static_cast<std::uint64_t>(slices), " slices of columns");
  work.host_ns = kHostSlice_ns * slices + kHostPixel_ns * p;
  work.device_ns = kDeviceSlice_ns * slices + kDevicePixel_ns * p;
  work.launches = kLaunches;
  work.bytes =
      map_bytes(map) / kFramesOfMap + pixels * ((targets.color8.empty() ? 0 : sizeof(Rgba8)) +
                                                (targets.depth.empty() ? 0 : sizeof(float)));
  return work;
}

}  // namespace rastrum::terrain
