// SPDX-License-Identifier: BSD-3-Clause
// The driver for a library of device code whose device is the CPU (library_test.cpp).
#include <rastrum/parallel/cuda/driver.hpp>

namespace rastrum::parallel {

CudaStatus driver_status() {
  return {.usable = true,
          .why_not = {},
          .name = "CPU in a library of its own",
          .free_bytes = std::uint64_t{1} << 36};
}

}  // namespace rastrum::parallel
