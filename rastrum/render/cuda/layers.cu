// SPDX-License-Identifier: BSD-3-Clause
// Instantiates the layers of a CUDA device. Tests compile this file as C++, for the CPU.
#include <rastrum/render/cuda/layers.cuh>

namespace rastrum::transparency {

RASTRUM_BLEND(, raster::LitOnDevice, raster::KeepsFragments);
RASTRUM_BLEND(, raster::MaterialOnDevice, raster::TestOnDevice);
RASTRUM_BLEND(, raster::ShadedOnce<raster::LitOnDevice>, raster::KeepsFragments);

}  // namespace rastrum::transparency
