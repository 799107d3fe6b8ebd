// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rastrum/raster/rules/scalar_lane.hpp>

namespace rastrum::transparency {
namespace scalar_lane {
using namespace raster::scalar_lane;  // NOLINT: the lane's names
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/transparency/over.inl>
#undef RASTRUM_LANES
}  // namespace scalar_lane

using scalar_lane::add_behind, scalar_lane::before, scalar_lane::over, scalar_lane::SeenPixel;

}  // namespace rastrum::transparency
