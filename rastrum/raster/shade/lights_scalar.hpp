// SPDX-License-Identifier: BSD-3-Clause
// A frame's lights at one point, for the host and for devices.
#pragma once

#include <rastrum/raster/rules/scalar_lane.hpp>
#include <rastrum/raster/shade/light_set.hpp>

namespace rastrum::raster::scalar_lane {
// As in kernels/lane_math-inl.hpp.
using Whole = int;
RASTRUM_HD inline Whole truncated(F v) {
  return static_cast<int>(v);
}
RASTRUM_HD inline F as_float(Whole v) {
  return static_cast<float>(v);
}
RASTRUM_HD inline Whole times_plus(Whole a, int by, Whole b) {
  return a * by + b;
}
RASTRUM_HD inline Whole plus(Whole a, int b) {
  return a + b;
}
RASTRUM_HD inline F looked_up(const float* table, Whole place) {
  return table[place];
}
RASTRUM_HD inline bool both(bool a, bool b) {
  return a && b;
}
RASTRUM_HD inline bool none(bool mask) {
  return !mask;
}
template <class Use>
RASTRUM_HD void for_each_value(F v, const Use& use) {
  use(v, true);
}
template <class Of>
RASTRUM_HD V3 lane_by_lane(const Of& of, const V3& a, F b) {
  return of.at(a, b);
}
#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/shade/lights.inl>
#undef RASTRUM_LANES
}  // namespace rastrum::raster::scalar_lane
