// SPDX-License-Identifier: BSD-3-Clause
// Blending with Highway, compiled once per instruction set. Multiply and add are not fused, so all
// give the same bits.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/transparency/blend_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <bit>

#include <rastrum/transparency/blend_kernels.hpp>
#include <rastrum/transparency/blend_lanes-inl.hpp>
#include <rastrum/transparency/over.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::transparency::HWY_NAMESPACE {
namespace {

/// Calls f(first pixel, lanes) for vectors with a pixel of `mask`.
template <class Each>
HWY_INLINE void for_each_vector(std::uint64_t mask, const Each& f) {
  constexpr std::uint64_t kVector = (std::uint64_t{1} << kLanes) - 1;
  while (mask != 0) {
    const std::size_t i = static_cast<std::size_t>(std::countr_zero(mask)) / kLanes * kLanes;
    f(i, hn::RebindMask(F32{}, lane_mask(mask >> i)));
    mask &= ~(kVector << i);
  }
}

std::uint64_t behind(const raster::BlockColors& layer, std::uint64_t mask, float opaque_at,
                     Seen& seen) noexcept {
  std::uint64_t opaque = 0;
  for_each_vector(mask, [&](std::size_t i, auto lanes) HWY_ATTR {
    SeenPixel pixel = load(seen, i);
    add_behind(pixel, choose_or_zero(lanes, load(layer, i)));
    store(pixel, seen, i);
    opaque |= std::uint64_t{lane_bits(hn::RebindMask(I32{}, pixel.through <= set(opaque_at)))} << i;
  });
  return opaque & mask;
}

void finish(const Seen& seen, const raster::BlockColors& behind,
            raster::BlockColors& out) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes) store(over(load(seen, i), load(behind, i)), out, i);
}

void put_before(const raster::BlockColors& layer, std::uint64_t mask,
                raster::BlockColors& colors) noexcept {
  for_each_vector(mask, [&](std::size_t i, auto lanes) HWY_ATTR {
    const V4 old = load(colors, i);
    store(choose(lanes, before(load(layer, i), old), old), colors, i);
  });
}

constexpr BlendKernels kTable{behind, finish, put_before};

}  // namespace
}  // namespace rastrum::transparency::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::transparency {
namespace {

std::uint64_t behind_scalar(const raster::BlockColors& layer, std::uint64_t mask, float opaque_at,
                            Seen& seen) noexcept {
  std::uint64_t opaque = 0;
  for (std::uint64_t m = mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    SeenPixel pixel = seen.at(i);
    add_behind(pixel, layer.at(i));
    seen.set(i, pixel);
    opaque |= std::uint64_t{pixel.through <= opaque_at} << i;
  }
  return opaque;
}

void finish_scalar(const Seen& seen, const raster::BlockColors& behind,
                   raster::BlockColors& out) noexcept {
  for (int i = 0; i < 64; ++i) out.set(i, over(seen.at(i), behind.at(i)));
}

void before_scalar(const raster::BlockColors& layer, std::uint64_t mask,
                   raster::BlockColors& colors) noexcept {
  for (std::uint64_t m = mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    colors.set(i, before(layer.at(i), colors.at(i)));
  }
}

constexpr BlendKernels kScalar{behind_scalar, finish_scalar, before_scalar};

}  // namespace

const BlendKernels& blend_kernels(Isa isa) noexcept {
  static constexpr const BlendKernels* kTables[] = RASTRUM_BY_ISA(kTable, &kScalar);
  return *kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::transparency
#endif
