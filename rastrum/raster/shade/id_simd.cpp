// Shader::id with Highway, compiled once per instruction set: id_color of each key.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/id_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/shade/wire.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

/// Colours of any keys: those that are 0 have one, too, which nobody reads.
void shade_ids(const VisibleBlock& block, BlockColors& colors) noexcept {
  const hn::CappedTag<std::uint64_t, 8> d64;
  const hn::Rebind<std::uint32_t, decltype(d64)> du;
  const hn::RebindToSigned<decltype(du)> di;
  const hn::Rebind<float, decltype(d64)> df;
  const auto mask = hn::Set(d64, kIdMask);
  const auto one = hn::Set(df, 1.0F / 255.0F);
  for (std::size_t i = 0; i < 64; i += hn::MaxLanes(d64)) {
    const auto id = mask - hn::And(hn::Load(d64, block.keys + i), mask);
    auto h = hn::TruncateTo(du, hn::Xor(id, hn::ShiftRight<32>(id)));
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    h = h * hn::Set(du, 0x85ebca6bU);
    h = hn::Xor(h, hn::ShiftRight<13>(h));
    h = h * hn::Set(du, 0xc2b2ae35U);
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    const auto store = [&](auto byte, float* to) HWY_ATTR {
      const auto level = hn::Or(hn::And(byte, hn::Set(du, 255U)), hn::Set(du, 32U));
      hn::Store(hn::ConvertTo(df, hn::BitCast(di, level)) * one, df, to + i);
    };
    store(h, colors.r);
    store(hn::ShiftRight<8>(h), colors.g);
    store(hn::ShiftRight<16>(h), colors.b);
  }
}

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

bool shade_id_simd(Isa isa, const VisibleBlock& block, BlockColors& colors) noexcept {
  using Shade = void (*)(const VisibleBlock&, BlockColors&);
  static constexpr Shade kShade[] = RASTRUM_BY_ISA(shade_ids, nullptr);
  const Shade shade = kShade[static_cast<std::size_t>(isa)];
  if (shade != nullptr) shade(block, colors);
  return shade != nullptr;
}

}  // namespace rastrum::raster
#endif
