// SPDX-License-Identifier: BSD-3-Clause
// Makes the frame of a device (frame.cuh) around a drawer of its surfaces.
#pragma once

#include <cstdint>
#include <memory>

#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/render/cuda/rasterizer.hpp>

namespace rastrum {

/// make_cuda_rasterizer with another `drawer`: all that a new way to draw needs.
[[nodiscard]] std::unique_ptr<CudaRasterizer> make_device_rasterizer(
    std::unique_ptr<raster::SurfaceDrawer> drawer, std::uint64_t memory_limit,
    MemoryAccount& memory, parallel::Threads& threads);

namespace raster {
/// By-size, the device's default.
[[nodiscard]] std::unique_ptr<SurfaceDrawer> make_by_size(DeviceSizes sizes);
}  // namespace raster

}  // namespace rastrum
