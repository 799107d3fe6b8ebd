// SPDX-License-Identifier: BSD-3-Clause
// The library of device code as it is opened (parallel/cuda/library.hpp): the tables of all floors
// in one. It is above them all; the program knows it by its file alone.
#include <rastrum/parallel/cuda/driver.hpp>
#include <rastrum/parallel/cuda/library.hpp>
#include <rastrum/render/cuda/rasterizer.hpp>
#include <rastrum/terrain/cuda/device.hpp>

// All else is hidden: what the library has of Rastrum's is its own copy.
__attribute__((visibility("default"))) const rastrum::parallel::CudaLibrary*
rastrum_cuda_library() noexcept {
  static const rastrum::parallel::CudaLibrary library{
      RASTRUM_CUDA_LIBRARY_VERSION, rastrum::parallel::driver_status, &rastrum::kCudaRendering,
      &rastrum::terrain::kCudaTerrain, rastrum::parallel::AddedTable::first()};
  return &library;
}
