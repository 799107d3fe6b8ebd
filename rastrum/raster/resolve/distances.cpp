// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/resolve/distances.hpp>

#include <bit>

#include <rastrum/raster/resolve/surface_point.hpp>

namespace rastrum::raster {

void distances_plain(const SurfaceScene& scene, const std::uint64_t* keys, int x0, int y0,
                     float nothing, float* view_depth, float* distance) {
  for (int i = 0; i < 64; ++i) {
    const auto depth = std::bit_cast<float>(static_cast<std::uint32_t>(keys[i] >> kIdBits));
    const double z = scene.distance_by_depth(depth);
    view_depth[i] = depth > 0 ? static_cast<float>(z) : nothing;
    if (distance == nullptr) continue;
    distance[i] = nothing;
    if (depth > 0)
      distance[i] =
          static_cast<float>(z * scene.ray_length(x0 + i % kBlockSize, y0 + i / kBlockSize));
  }
}

}  // namespace rastrum::raster
