// SPDX-License-Identifier: BSD-3-Clause
// All differences between CUDA and the CPU below this folder's words. nvcc takes system_gpu.cuh; a
// C++ compiler with THRUST_DEVICE_SYSTEM_CPP takes system_cpu.cuh. All other code is shared, so the
// words' tests also run without a GPU.
#pragma once

#include <utility>

#include <thrust/detail/config.h>
#include <thrust/system_error.h>

#include <rastrum/error.hpp>

// The namespace differs, because a test on the CPU may link with the library's GPU code.
#if THRUST_DEVICE_SYSTEM == THRUST_DEVICE_SYSTEM_CUDA
#define RASTRUM_DEVICE_SYSTEM on_gpu
#include <rastrum/parallel/cuda/system_gpu.cuh>
#elif THRUST_DEVICE_SYSTEM == THRUST_DEVICE_SYSTEM_CPP
#define RASTRUM_DEVICE_SYSTEM on_cpu
#include <rastrum/parallel/cuda/system_cpu.cuh>
#else
#error "the words of rastrum/parallel/cuda know THRUST_DEVICE_SYSTEM_CUDA and _CPP"
#endif

namespace rastrum::parallel::cuda_system {
inline namespace RASTRUM_DEVICE_SYSTEM {

/// While it lives, this thread's calls go to `device`.
class DeviceScope {
 public:
  explicit DeviceScope(int device) : before_(current_device()), device_(device) {
    if (device_ != before_) set_device(device_);
  }
  ~DeviceScope() {
    if (device_ == before_) return;
    try {
      set_device(before_);
    } catch (const Error&) {
      // Restoring failed: the next call will report a lost device.
    }
  }
  DeviceScope(const DeviceScope&) = delete;
  DeviceScope& operator=(const DeviceScope&) = delete;

 private:
  int before_, device_;
};

/// Returns f() and turns Thrust's exceptions into Errors, because callers do not know that type.
template <class F>
decltype(auto) with_errors(F&& f) {
  try {
    return std::forward<F>(f)();
  } catch (const thrust::system_error& error) {
    fail(error);
  }
}

}  // namespace RASTRUM_DEVICE_SYSTEM
}  // namespace rastrum::parallel::cuda_system
