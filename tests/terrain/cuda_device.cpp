// SPDX-License-Identifier: BSD-3-Clause
// A program whose device is the CPU, like tests/raster/cuda/cuda_on_cpu.cpp, with memory that a
// test sets. So TerrainRenderer works as on a GPU.
#include "tests/terrain/cuda_device.hpp"

#include <rastrum/parallel/cuda/driver.hpp>
#include <rastrum/parallel/cuda/host_stream.hpp>
#include <rastrum/parallel/cuda/host_walls.hpp>
#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum {
namespace {
std::uint64_t free_bytes = 0;

[[maybe_unused]] const bool is_taken =
    (parallel::set_cuda_library(*rastrum_cuda_library()),
     parallel::cuda_system::HostStream::be_late(true), parallel::cuda_system::Walls::stand(), true);
}  // namespace

namespace parallel {
CudaStatus driver_status() {
  return {
      .usable = true, .why_not = {}, .name = "CPU in the place of a GPU", .free_bytes = free_bytes};
}
}  // namespace parallel

bool test::TerrainOnDevice::set_free_bytes(std::uint64_t bytes) {
  free_bytes = bytes;
  return true;
}

}  // namespace rastrum
