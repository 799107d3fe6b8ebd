// A frame's lights at one point, for the host and for devices.
#pragma once

#include <rastrum/raster/kernels/scalar_lane.hpp>
#include <rastrum/raster/shade/light_set.hpp>

namespace rastrum::raster::scalar_lane {
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/shade/lights-inl.hpp>
#undef RASTRUM_LANES
}  // namespace rastrum::raster::scalar_lane
