// SPDX-License-Identifier: BSD-3-Clause
// Quadrics in lanes, for SIMD sources that cover pieces or make keys: declared once per instruction
// set, defined in quadric_simd.cpp. Include it after highway.h, outside of any namespace.

// Highway compiles a source once per target; this guard lets the header in once per target too.
#if defined(RASTRUM_RASTER_COVER_QUADRIC_KERNELS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RASTRUM_RASTER_COVER_QUADRIC_KERNELS_INL_HPP
#undef RASTRUM_RASTER_COVER_QUADRIC_KERNELS_INL_HPP
#else
#define RASTRUM_RASTER_COVER_QUADRIC_KERNELS_INL_HPP
#endif

#include <cstdint>

#include <hwy/highway.h>

#include <rastrum/raster/rules/piece.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {

/// cover_quadric (coverage.hpp). `within`, in px, is not empty and inside of the piece's box.
std::uint64_t quadric_mask(const Piece& piece, int bx, int by, Rect within) noexcept;
/// Kernels::keys of a quadric's piece, where the mask is set.
void quadric_keys(const Piece& piece, const Block& block, std::uint64_t* keys) noexcept;

}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET
#endif  // RASTRUM_RASTER_COVER_QUADRIC_KERNELS_INL_HPP
