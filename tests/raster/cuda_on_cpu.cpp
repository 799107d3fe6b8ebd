// What a program says of its device whose code for devices is compiled for the CPU: in the place of
// the library's, which looks for a driver.
#include <rastrum/parallel/cuda/status.hpp>

namespace rastrum::parallel {

CudaStatus cuda_status() {
  CudaStatus status;
  status.usable = true;
  status.name = "CPU that stands for a GPU";
  return status;
}

}  // namespace rastrum::parallel
