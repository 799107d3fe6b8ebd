// SPDX-License-Identifier: BSD-3-Clause
// Whether a CUDA device is usable; callable from any build, on any machine.
#pragma once

#include <cstdint>
#include <string>

namespace rastrum::parallel {

struct CudaStatus {
  bool usable = false;
  /// If not usable: what is missing and what to do, as the end of a sentence.
  std::string why_not;
  std::string name;  ///< of the current device
  std::uint64_t free_bytes = 0;
};

/// Opens the library of device code (library.hpp) and asks the driver, whose context takes some
/// tenths of a second the first time. Throws only std::bad_alloc.
[[nodiscard]] CudaStatus cuda_status();

}  // namespace rastrum::parallel
