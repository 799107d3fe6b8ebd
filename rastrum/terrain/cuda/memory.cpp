// SPDX-License-Identifier: BSD-3-Clause
// Which terrains a device draws and how much memory they take, without a CUDA header.
#include <algorithm>

#include <rastrum/terrain/cuda/device.hpp>
#include <rastrum/terrain/device_work.hpp>
#include <rastrum/terrain/function_light.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {

std::string why_not_on_device(const Terrain& terrain, const TerrainOptions& options) {
  if (terrain.is_map()) return {};
  if (!function_view(terrain))
    return "this terrain is a caller's function or an expression, which only the CPU can call";
  return options.classic ? "only the CPU draws the classic picture of a function" : std::string();
}

std::uint64_t device_bytes(const Terrain& terrain, const TerrainOptions& options) {
  // Maxima of 16 × 16 cells and more form a pyramid, whose odd sizes round up.
  const std::uint64_t map = map_bytes(terrain);
  std::uint64_t bytes = map + map / 128;
  if (options.filter == MapFilter::mip) bytes += map / 2;
  // The picture, and the upright one, which is no smaller if the picture is rolled.
  bytes += 2 * (sizeof(Rgba8) + sizeof(float)) * static_cast<std::uint64_t>(options.width) *
           static_cast<std::uint64_t>(options.height);
  const auto slices = static_cast<std::uint64_t>(std::min(slice_count(options), kMaxSlices));
  // Where teams of 16 columns begin on the classic slices.
  constexpr std::uint64_t kTeamColumns = 16, kStartBytes = 16;
  if (options.classic)
    bytes += kStartBytes * slices * (static_cast<std::uint64_t>(options.width) / kTeamColumns + 1);
  if (!terrain.is_map())
    if (const auto function = function_view(terrain)) bytes += function->steps.size_bytes();
  // The setup's lists, then a quarter more, because an arena rounds blocks up.
  constexpr std::uint64_t kSetupBytes = 64, kSmall = std::uint64_t{1} << 20;
  bytes += kSmall + kSetupBytes * slices;
  return bytes + bytes / 4;
}

}  // namespace rastrum::terrain
