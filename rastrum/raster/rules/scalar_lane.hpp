// SPDX-License-Identifier: BSD-3-Clause
// One float as lanes (lane_math-inl.hpp), for the scalar instruction set and for devices.
#pragma once

#include <cmath>

#include <rastrum/config.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster::scalar_lane {

using F = float;
using V3 = Vec3;
using V4 = Vec4;

RASTRUM_HD inline F set(float v) {
  return v;
}
RASTRUM_HD inline V3 set(Vec3 v) {
  return v;
}
RASTRUM_HD inline F square_root(F v) {
  return std::sqrt(v);
}
RASTRUM_HD inline F min_of(F a, F b) {
  return a < b ? a : b;
}
RASTRUM_HD inline F max_of(F a, F b) {
  return a > b ? a : b;
}
template <class V>
RASTRUM_HD V choose(bool mask, V yes, V no) {
  return mask ? yes : no;
}
template <class V>
RASTRUM_HD V choose_or_zero(bool mask, V yes) {
  return mask ? yes : V{};
}

}  // namespace rastrum::raster::scalar_lane
