// SPDX-License-Identifier: BSD-3-Clause
// A library of device code of another Rastrum. Only its version may be read.
namespace rastrum::parallel {
struct CudaLibrary;
}

extern "C" __attribute__((visibility("default"))) const rastrum::parallel::CudaLibrary*
rastrum_cuda_library() noexcept {
  struct Other {
    const char* version;
  };
  static const Other other{"0.0.1-of-another"};
  return reinterpret_cast<const rastrum::parallel::CudaLibrary*>(&other);
}
