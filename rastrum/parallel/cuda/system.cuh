// SPDX-License-Identifier: BSD-3-Clause
// All that CUDA and the CPU do differently under the words of this folder, and nothing else. nvcc
// takes system_gpu.cuh. A plain C++ compiler that is told THRUST_DEVICE_SYSTEM_CPP takes
// system_cpu.cuh. The rest of the code is the same, so the words' tests run it where there is no
// GPU.
#pragma once

#include <utility>

#include <thrust/detail/config.h>
#include <thrust/system_error.h>

#include <rastrum/error.hpp>

// Names say which half they are of: a test on the CPU may be linked with the library's code for
// GPUs.
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

/// While it lives, this thread's calls are of `device`.
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
      // It was current before: a device that is lost says so to the next call.
    }
  }
  DeviceScope(const DeviceScope&) = delete;
  DeviceScope& operator=(const DeviceScope&) = delete;

 private:
  int before_, device_;
};

/// f(), of which all that fails is an Error: Thrust's algorithms throw an exception of their own.
/// Around what others call of the device's code, since no one else knows that type.
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
