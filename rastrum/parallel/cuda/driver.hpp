// SPDX-License-Identifier: BSD-3-Clause
// Asks the CUDA driver about its device; part of the library of device code alone (library.hpp).
#pragma once

#include <rastrum/parallel/cuda/status.hpp>

namespace rastrum::parallel {

/// cuda_status() where that library is there. Tests on the CPU have one of their own.
[[nodiscard]] CudaStatus driver_status();

}  // namespace rastrum::parallel
