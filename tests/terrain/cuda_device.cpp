// parallel::cuda_status for a program whose device is the CPU. It stands in for the library's,
// which would say that there is no GPU; so TerrainRenderer takes the way that it takes on one.
#include "tests/terrain/cuda_device.hpp"

namespace rastrum {
namespace {
std::uint64_t free_bytes = 0;
}

namespace parallel {
CudaStatus cuda_status() {
  CudaStatus status;
  status.usable = true;
  status.name = "CPU in the place of a GPU";
  status.free_bytes = free_bytes;
  return status;
}
}  // namespace parallel

bool test::TerrainOnDevice::set_free_bytes(std::uint64_t bytes) {
  free_bytes = bytes;
  return true;
}

}  // namespace rastrum
