// SPDX-License-Identifier: BSD-3-Clause
// The layers of each pair of shader and test in raster::DeviceShading, in a file of their own
// (layers.cu), because nvcc takes as long for them as for the rest of a frame.
#pragma once

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/samples.cuh>
#include <rastrum/raster/cuda/shading.cuh>
#include <rastrum/transparency/cuda/scene_layers.cuh>

#define RASTRUM_BLEND(Prefix, Shade, Test)                                                       \
  Prefix template void SceneLayers::blend(                                                       \
      parallel::Cuda&, const raster::DeviceScene<parallel::Cuda>&, const raster::DeviceSurface&, \
      std::span<Vec4>, const TransparencyOptions&, const Shade&, const Test&, std::uint64_t,     \
      std::uint64_t);                                                                            \
  Prefix template bool SceneLayers::blend_left(                                                  \
      parallel::Cuda&, const LeftLayers&, const raster::DeviceSurface&, std::span<Vec4>,         \
      const TransparencyOptions&, const Shade&, const Test&, std::uint64_t, const FinishBand&)

namespace rastrum::transparency {

RASTRUM_BLEND(extern, raster::LitOnDevice, raster::KeepsFragments);
RASTRUM_BLEND(extern, raster::MaterialOnDevice, raster::TestOnDevice);
RASTRUM_BLEND(extern, raster::ShadedOnce<raster::LitOnDevice>, raster::KeepsFragments);

}  // namespace rastrum::transparency
