// SPDX-License-Identifier: BSD-3-Clause
// lights.inl in lanes.
#if defined(RASTRUM_RASTER_SHADE_LIGHTS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_LIGHTS_INL_HPP
#undef RASTRUM_RASTER_SHADE_LIGHTS_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_LIGHTS_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/kernels/lane_math-inl.hpp>
#include <rastrum/raster/shade/light_set.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/shade/lights.inl>
#undef RASTRUM_LANES

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_LIGHTS_INL_HPP
