// A frame's lights at one point, for the host and for devices.
#pragma once

#include <rastrum/raster/kernels/scalar_lane.hpp>
#include <rastrum/raster/shade/light_set.hpp>

namespace rastrum::raster::scalar_lane {
/// What `of` says of two vectors; lanes have the same (kernels/lane_by_lane-inl.hpp).
template <class Of>
RASTRUM_HD F lane_by_lane(const Of& of, const V3& a, const V3& b) {
  return of.at(a, b);
}
template <class Of>
RASTRUM_HD V3 lane_by_lane(const Of& of, const V3& a, F b) {
  return of.at(a, b);
}
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/shade/lights-inl.hpp>
#undef RASTRUM_LANES
}  // namespace rastrum::raster::scalar_lane
