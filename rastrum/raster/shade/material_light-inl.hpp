// SPDX-License-Identifier: BSD-3-Clause
// material_light.inl and classic_light.inl in lanes.
#if defined(RASTRUM_RASTER_SHADE_MATERIAL_LIGHT_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_SHADE_MATERIAL_LIGHT_INL_HPP
#undef RASTRUM_RASTER_SHADE_MATERIAL_LIGHT_INL_HPP
#else
#define RASTRUM_RASTER_SHADE_MATERIAL_LIGHT_INL_HPP
#endif

#include <hwy/highway.h>

#include <rastrum/raster/shade/lights-inl.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material_constants.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {

#define RASTRUM_LANES HWY_INLINE
#include <rastrum/raster/shade/classic_light.inl>
#include <rastrum/raster/shade/material_light.inl>
#undef RASTRUM_LANES

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_SHADE_MATERIAL_LIGHT_INL_HPP
