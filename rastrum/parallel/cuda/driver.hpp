// SPDX-License-Identifier: BSD-3-Clause
// Asks the CUDA driver about its device. Only the library of device code has it (library.hpp).
#pragma once

#include <rastrum/parallel/cuda/status.hpp>

namespace rastrum::parallel {

/// The result of cuda_status() if there is that library. Tests on the CPU define their own.
[[nodiscard]] CudaStatus driver_status();

}  // namespace rastrum::parallel
