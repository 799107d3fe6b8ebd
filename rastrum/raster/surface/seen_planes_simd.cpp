// SPDX-License-Identifier: BSD-3-Clause
// A block's triangles and interpolation by their float64 weights (seen_planes.hpp), compiled once
// per instruction set.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/surface/seen_planes_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#define RASTRUM_MOST_LANES 16  // a pixel or a triangle a lane
#include <rastrum/raster/surface/seen_planes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

void see(const FrameGeometry& frame, const VisibleBlock& block, SeenPlanes& out) noexcept {
  see_planes(frame, block, out);
}

/// For a block that sees only triangle 0.
struct OneLookup {
  explicit HWY_INLINE OneLookup(I /*place*/) {}
  HWY_INLINE Wide operator()(const double* values) const { return wide(values[0]); }
};

template <class Use>
HWY_INLINE void for_each_seen(const SeenPlanes& seen, std::uint64_t pixels, const Use& use) {
  const auto group = [&](std::size_t first, std::size_t g, const auto& look, auto mine)
                         HWY_ATTR { use(first, look, g * kLanes, mine); };
  if (seen.count == 1)
    for_each_group<OneLookup>(seen.place, 1, pixels, group);
  else
    for_each_group<WideLookup>(seen.place, seen.count, pixels, group);
}

HWY_INLINE Wide choose(hn::Mask<F32> mask, const Wide& yes, const Wide& no) {
  const std::uint64_t bits = bits_of(mask);
  const auto half = [&](std::uint64_t of_half, D y, D n) HWY_ATTR {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(of_half & ((1U << kHalf) - 1))};
    return hn::IfThenElse(hn::LoadMaskBits(F64{}, bytes), y, n);
  };
  return {half(bits, yes.lower, no.lower), half(bits >> kHalf, yes.upper, no.upper)};
}

void shares(const SeenPlanes& seen, const VisibleBlock& block, ByCorner& out) noexcept {
  using T = PlaneTable<64>;
  for_each_seen(
      seen, block.covered,
      [&](std::size_t first, const auto& look, std::size_t offset, auto mine) HWY_ATTR {
        const auto number = [&](std::size_t which)
                                HWY_ATTR { return look(seen.planes.number[which] + offset); };
        const WidePoints at(block, first);
        const Wide dx = at.x - number(T::kX0), dy = at.y - number(T::kY0);
        Wide b[3];
        for (std::size_t c = 0; c < 3; ++c)
          b[c] = number(T::kR + 3 * c) + number(T::kP + 3 * c) * dx + number(T::kQ + 3 * c) * dy;
        make_shares(b);
        for (std::size_t c = 0; c < 3; ++c) {
          double* const to = &out[c][first];
          store(choose(mine, b[c], load_wide(to)), to);
        }
      });
}

void barycentrics(const ByCorner& shares, Vec2* out) noexcept {
  for (std::size_t i = 0; i < 64; i += kLanes)
    hn::StoreInterleaved2(rounded(load_wide(&shares[1][i])), rounded(load_wide(&shares[2][i])),
                          F32{}, &out[i].x);
}

void positions(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
               const ByCorner (&corner)[3], const Mat4d& object_to_world, Vec3* out) noexcept {
  const auto& m = object_to_world.m;
  for_each_seen(
      seen, mask, [&](std::size_t first, const auto& look, std::size_t offset, auto mine) HWY_ATTR {
        const auto axis = [&](const ByCorner& v) HWY_ATTR {
          return look(&v[0][offset]) * load_wide(&shares[0][first]) +
                 look(&v[1][offset]) * load_wide(&shares[1][first]) +
                 look(&v[2][offset]) * load_wide(&shares[2][first]);
        };
        const Wide x = axis(corner[0]), y = axis(corner[1]), z = axis(corner[2]);
        const auto row = [&](int i) HWY_ATTR {
          return rounded(wide(m[i][0]) * x + wide(m[i][1]) * y + wide(m[i][2]) * z + wide(m[i][3]));
        };
        HWY_ALIGN Vec3 place[kLanes];
        hn::StoreInterleaved3(row(0), row(1), row(2), F32{}, &place[0].x);
        const std::uint64_t wanted = bits_of(mine) & mask >> first;
        if (wanted == (std::uint64_t{1} << kLanes) - 1)
          std::copy_n(place, kLanes, out + first);
        else
          for (std::uint64_t rest = wanted; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rest));
            out[first + i] = place[i];
          }
      });
}

void numbers(const SeenPlanes& seen, const ByCorner& shares, std::uint64_t mask,
             const ByCorner& corner, Numbers64& out) noexcept {
  const auto mix = [](D b0, D b1, D b2, D v0, D v1, D v2) HWY_ATTR {
    const auto lesser = [](D a, D b) HWY_ATTR { return hn::IfThenElse(b < a, b, a); };
    const auto greater = [](D a, D b) HWY_ATTR { return hn::IfThenElse(a < b, b, a); };
    const D value = v0 * b0 + v1 * b1 + v2 * b2;
    const D low = lesser(lesser(v0, v1), v2), high = greater(greater(v0, v1), v2);
    const D cut = hn::IfThenElse(value < low, low, hn::IfThenElse(value > high, high, value));
    const D said = hn::IfThenElse(hn::Eq(low, high), low, cut);
    const auto nan = hn::Or(hn::IsNaN(v0), hn::Or(hn::IsNaN(v1), hn::IsNaN(v2)));
    return hn::IfThenElse(nan, value, said);
  };
  for_each_seen(
      seen, mask, [&](std::size_t first, const auto& look, std::size_t offset, auto mine) HWY_ATTR {
        const auto share = [&](std::size_t c) HWY_ATTR { return load_wide(&shares[c][first]); };
        const Wide v0 = look(&corner[0][offset]), v1 = look(&corner[1][offset]),
                   v2 = look(&corner[2][offset]);
        const Wide b0 = share(0), b1 = share(1), b2 = share(2);
        const Wide value{mix(b0.lower, b1.lower, b2.lower, v0.lower, v1.lower, v2.lower),
                         mix(b0.upper, b1.upper, b2.upper, v0.upper, v1.upper, v2.upper)};
        double* const to = &out[first];
        store(choose(mine, value, load_wide(to)), to);
      });
}

constexpr SeenKernels kTable{see, shares, barycentrics, positions, numbers};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

const SeenKernels* seen_kernels(Isa isa) noexcept {
  static constexpr const SeenKernels* kTables[] = RASTRUM_BY_ISA(kTable, nullptr);
  return kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
