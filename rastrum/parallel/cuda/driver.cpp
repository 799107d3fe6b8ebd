// SPDX-License-Identifier: BSD-3-Clause
// The CUDA runtime is linked statically and looks for the driver when called, so the library of
// device code opens on machines without one.
#include <rastrum/parallel/cuda/driver.hpp>

#include <cuda_runtime_api.h>

namespace rastrum::parallel {
namespace {

std::string why_not(cudaError_t error) {
  switch (error) {
    case cudaErrorInsufficientDriver:
    case cudaErrorStubLibrary: {
      int driver = 0;
      if (cudaDriverGetVersion(&driver) == cudaSuccess && driver > 0)
        return std::string("the NVIDIA driver is for CUDA ")
            .append(std::to_string(driver / 1000))
            .append(" and this program for CUDA ")
            .append(std::to_string(CUDART_VERSION / 1000))
            .append("; install a newer driver");
      return "this machine has no NVIDIA driver; install it, or nvidia-container-toolkit for a "
             "container";
    }
    case cudaErrorNoDevice:
      return "the NVIDIA driver finds no GPU; look at nvidia-smi and CUDA_VISIBLE_DEVICES";
    case cudaErrorMemoryAllocation:
      return "the GPU does not even have memory for a context; end other programs that run there "
             "(nvidia-smi)";
    default:
      return std::string("the NVIDIA driver says: ").append(cudaGetErrorString(error));
  }
}

}  // namespace

CudaStatus driver_status() {
  CudaStatus status;
  int count = 0, device = 0;
  std::size_t free = 0, total = 0;
  cudaDeviceProp properties{};
  cudaError_t error = cudaGetDeviceCount(&count);
  if (error == cudaSuccess && count == 0) error = cudaErrorNoDevice;
  if (error == cudaSuccess) error = cudaGetDevice(&device);
  if (error == cudaSuccess) error = cudaGetDeviceProperties(&properties, device);
  if (error == cudaSuccess) error = cudaMemGetInfo(&free, &total);
  if (error != cudaSuccess) {
    static_cast<void>(cudaGetLastError());
    status.why_not = why_not(error);
    return status;
  }
  status.name = properties.name;
  status.free_bytes = free;
  if (properties.major < 8)
    status.why_not = std::string("the ")
                         .append(properties.name)
                         .append(
                             " is older than what this program is compiled for (compute "
                             "capability 8.0, the A100, or newer)");
  else
    status.usable = true;
  return status;
}

}  // namespace rastrum::parallel
