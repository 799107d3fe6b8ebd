// SPDX-License-Identifier: BSD-3-Clause
// The approximations in vectors of pixels with Highway, compiled once per instruction set. Multiply
// and add are never fused, so all have the bits of the scalar form.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "papers/paper4/approximations_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <papers/paper4/approximation_kernels.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/transparency/blend_kernels.hpp>
#include <rastrum/transparency/blend_lanes-inl.hpp>
#include <rastrum/transparency/over.hpp>
#include <rastrum/transparency/packed_kernels.hpp>

#ifndef RASTRUM_PAPERS_APPROXIMATIONS_SIMD_CPP_ONCE_
#define RASTRUM_PAPERS_APPROXIMATIONS_SIMD_CPP_ONCE_
namespace rastrum::family::approximations {
using raster::BlockColors;
using transparency::Layer;
using transparency::PackedRow;

/// The share of the mass at a fragment's own depth that counts as in front of it (the paper's
/// overestimation).
inline constexpr float kOverestimation = 0.25F;
/// The largest alpha in −log(1 − α). The background's share is then 10⁻⁶.
inline constexpr float kMostAlpha = 1 - 1e-6F;
/// Replaces a depth of 0, which fragments at infinity have.
inline constexpr float kLeastDepth = 1e-30F;
}  // namespace rastrum::family::approximations
#endif

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::family::approximations::HWY_NAMESPACE {
namespace {
using namespace transparency::HWY_NAMESPACE;  // NOLINT: the lanes' names
using transparency::HWY_NAMESPACE::load, transparency::HWY_NAMESPACE::store;
using U64 = hn::RebindToUnsigned<I64>;

constexpr std::uint64_t kVector = (std::uint64_t{1} << kLanes) - 1;

HWY_INLINE I integer(std::int32_t v) {
  return hn::Set(I32{}, v);
}
HWY_INLINE I bits(F v) {
  return hn::BitCast(I32{}, v);
}
HWY_INLINE F from_bits(I v) {
  return hn::BitCast(F32{}, v);
}
HWY_INLINE F to_float(I v) {
  return hn::ConvertTo(F32{}, v);
}
HWY_INLINE I shift_left_23(I v) {
  return hn::ShiftLeft<23>(v);
}
HWY_INLINE I shift_right_23(I v) {
  return hn::ShiftRight<23>(v);
}
HWY_INLINE F load(const float* from) {
  return hn::Load(F32{}, from);
}
HWY_INLINE void store(F v, float* to) {
  hn::Store(v, F32{}, to);
}
HWY_INLINE hn::Mask<F32> lanes_of(std::uint64_t mask) {
  return hn::RebindMask(F32{}, lane_mask(mask));
}
HWY_INLINE hn::Vec<U32> high_halves(const std::uint64_t* keys) {
  return hn::ConcatOdd(U32{}, hn::BitCast(U32{}, hn::LoadU(U64{}, keys + kLanes64)),
                       hn::BitCast(U32{}, hn::LoadU(U64{}, keys)));
}
HWY_INLINE hn::Vec<U32> low_halves(const std::uint64_t* keys) {
  return hn::ConcatEven(U32{}, hn::BitCast(U32{}, hn::LoadU(U64{}, keys + kLanes64)),
                        hn::BitCast(U32{}, hn::LoadU(U64{}, keys)));
}
HWY_INLINE F depths(const std::uint64_t* keys) {
  return hn::BitCast(F32{}, hn::ShiftRight<raster::kIdBits - 32>(high_halves(keys)));
}
HWY_INLINE hn::Mask<F32> any_key(const std::uint64_t* keys) {
  const auto any = hn::Or(high_halves(keys), low_halves(keys));
  return hn::RebindMask(F32{}, hn::Ne(any, hn::Zero(U32{})));
}

#define RASTRUM_LANES HWY_INLINE
#include <papers/paper4/approximations.inl>
#undef RASTRUM_LANES

}  // namespace
}  // namespace rastrum::family::approximations::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::family {
namespace approximations {
namespace scalar {
namespace {
using namespace transparency::scalar_lane;  // NOLINT: the lane's names
using I = std::int32_t;

constexpr std::size_t kLanes = 1;
constexpr std::uint64_t kVector = 1;

I integer(std::int32_t v) {
  return v;
}
I bits(F v) {
  return std::bit_cast<I>(v);
}
F from_bits(I v) {
  return std::bit_cast<F>(v);
}
F to_float(I v) {
  return static_cast<F>(v);
}
I shift_left_23(I v) {
  return v * (1 << 23);
}
I shift_right_23(I v) {
  return v >> 23;
}
F load(const float* from) {
  return *from;
}
V4 load(const BlockColors& from, std::size_t i) {
  return from.at(static_cast<int>(i));
}
void store(F v, float* to) {
  *to = v;
}
void store(const V4& v, BlockColors& to, std::size_t i) {
  to.set(static_cast<int>(i), v);
}
bool lanes_of(std::uint64_t mask) {
  return (mask & 1) != 0;
}
F depths(const std::uint64_t* keys) {
  return raster::depth_of_key(*keys);
}
bool any_key(const std::uint64_t* keys) {
  return *keys != 0;
}
V4 load_colors(const std::uint64_t* sort_keys, const Vec4* colors) {
  return colors[transparency::color_of_sort_key(*sort_keys)];
}

#define RASTRUM_LANES inline
#include <papers/paper4/approximations.inl>
#undef RASTRUM_LANES

}  // namespace
}  // namespace scalar

const ApproximationKernels& by_isa(Isa isa) noexcept {
  static constexpr const ApproximationKernels* kTables[] = RASTRUM_BY_ISA(kTable, &scalar::kTable);
  return *kTables[static_cast<std::size_t>(isa)];
}

}  // namespace approximations

void MomentBlock::clear() {
  std::fill_n(nearest, 8, 0.0F);
  std::fill_n(farthest, 8, 1.0F);
  for (auto& plane : sum) std::fill_n(plane, 64, 0.0F);
  colors = {};
}

void MomentBlock::set_warp() {
  warp.nearest = std::max(*std::max_element(nearest, nearest + 8), approximations::kLeastDepth);
  warp.farthest = *std::min_element(farthest, farthest + 8);
  const float range = approximations::scalar::log_ratio(warp.nearest, warp.farthest);
  warp.scale = range > 0 ? 2 / range : 0.0F;
  warp.offset = range > 0 ? -1.0F : 0.0F;
}

void WeightedBlock::clear() {
  sum = {};
  std::fill_n(through, 64, 1.0F);
}

void MultiLayerBlock::clear() {
  for (auto& layer : layers) {
    layer = {};
    std::fill_n(layer.depth, 64, -1.0F);
    std::fill_n(layer.through, 64, 1.0F);
  }
}

const ApproximationKernels& approximation_kernels(Isa isa) noexcept {
  return approximations::by_isa(isa);
}

}  // namespace rastrum::family
#endif
