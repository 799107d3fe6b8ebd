// SPDX-License-Identifier: BSD-3-Clause
// The entry point of the library of device code (parallel/cuda/library.hpp): the tables of all
// floors in one. It lies above all floors, and the program knows it only as a file.
#include <rastrum/parallel/cuda/driver.hpp>
#include <rastrum/parallel/cuda/library.hpp>
#include <rastrum/render/cuda/rasterizer.hpp>
#include <rastrum/terrain/cuda/device.hpp>

// All else is hidden: the library's copy of Rastrum's code stays its own.
__attribute__((visibility("default"))) const rastrum::parallel::CudaLibrary*
rastrum_cuda_library() noexcept {
  static const rastrum::parallel::CudaLibrary library{
      RASTRUM_CUDA_LIBRARY_VERSION, rastrum::parallel::driver_status, &rastrum::kCudaRendering,
      &rastrum::terrain::kCudaTerrain, rastrum::parallel::AddedTable::first()};
  return &library;
}
