// Blending in vectors of pixels with Highway, compiled once per instruction set. Multiply and add
// are kept apart, so all give the bits of the scalar loops.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/transparency/blend_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <bit>

#include <rastrum/raster/kernels/lanes-inl.hpp>
#include <rastrum/transparency/blend_kernels.hpp>
#include <rastrum/transparency/over.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::transparency {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using namespace raster::HWY_NAMESPACE;  // NOLINT: the lanes' names

/// Calls f(first pixel, lanes) for the vectors that hold any pixel of `mask`.
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
  const F32 d;
  const F limit = hn::Set(d, opaque_at), one = hn::Set(d, 1.0F);
  std::uint64_t opaque = 0;
  for_each_vector(mask, [&](std::size_t i, auto lanes) HWY_ATTR {
    const F through = hn::Load(d, seen.through + i);
    const auto add = [&](const float* channel, float* sum) HWY_ATTR {
      const F c = hn::IfThenElseZero(lanes, hn::Load(d, channel + i));
      hn::Store(hn::Add(hn::Load(d, sum + i), hn::Mul(through, c)), d, sum + i);
      return c;
    };
    add(layer.r, seen.r);
    add(layer.g, seen.g);
    add(layer.b, seen.b);
    const F a = add(layer.a, seen.a);
    const F left = hn::Mul(through, hn::Sub(one, a));
    hn::Store(left, d, seen.through + i);
    opaque |= std::uint64_t{lane_bits(hn::RebindMask(I32{}, hn::Le(left, limit)))} << i;
  });
  return opaque & mask;
}

void finish(const Seen& seen, const raster::BlockColors& behind,
            raster::BlockColors& out) noexcept {
  const F32 d;
  const F one = hn::Set(d, 1.0F);
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const F through = hn::Load(d, seen.through + i);
    const auto over = [&](const float* sum, const float* channel) HWY_ATTR {
      return hn::Add(hn::Load(d, sum + i), hn::Mul(through, hn::Load(d, channel + i)));
    };
    hn::Store(over(seen.r, behind.r), d, out.r + i);
    hn::Store(over(seen.g, behind.g), d, out.g + i);
    hn::Store(over(seen.b, behind.b), d, out.b + i);
    const F left = hn::Mul(through, hn::Sub(one, hn::Load(d, behind.a + i)));
    hn::Store(hn::IfThenElse(hn::Eq(left, hn::Zero(d)), one, over(seen.a, behind.a)), d, out.a + i);
  }
}

void before(const raster::BlockColors& layer, std::uint64_t mask,
            raster::BlockColors& colors) noexcept {
  const F32 d;
  for_each_vector(mask, [&](std::size_t i, auto lanes) HWY_ATTR {
    const F behind = hn::Sub(hn::Set(d, 1.0F), hn::Load(d, layer.a + i));
    const auto put = [&](const float* channel, float* out) HWY_ATTR {
      const F old = hn::Load(d, out + i);
      const F sum = hn::Add(hn::Load(d, channel + i), hn::Mul(behind, old));
      hn::Store(hn::IfThenElse(lanes, sum, old), d, out + i);
    };
    put(layer.r, colors.r);
    put(layer.g, colors.g);
    put(layer.b, colors.b);
    put(layer.a, colors.a);
  });
}

constexpr BlendKernels kTable{behind, finish, before};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::transparency
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
namespace rastrum::transparency {
namespace {

SeenPixel at(const Seen& seen, int i) {
  return {seen.r[i], seen.g[i], seen.b[i], seen.a[i], seen.through[i]};
}
Vec4 at(const raster::BlockColors& colors, int i) {
  return {colors.r[i], colors.g[i], colors.b[i], colors.a[i]};
}

std::uint64_t behind_scalar(const raster::BlockColors& layer, std::uint64_t mask, float opaque_at,
                            Seen& seen) noexcept {
  std::uint64_t opaque = 0;
  for (std::uint64_t m = mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    SeenPixel pixel = at(seen, i);
    add_behind(pixel, at(layer, i));
    seen.r[i] = pixel.r;
    seen.g[i] = pixel.g;
    seen.b[i] = pixel.b;
    seen.a[i] = pixel.a;
    seen.through[i] = pixel.through;
    opaque |= std::uint64_t{pixel.through <= opaque_at} << i;
  }
  return opaque;
}

void finish_scalar(const Seen& seen, const raster::BlockColors& behind,
                   raster::BlockColors& out) noexcept {
  for (int i = 0; i < 64; ++i) out.set(i, over(at(seen, i), at(behind, i)));
}

void before_scalar(const raster::BlockColors& layer, std::uint64_t mask,
                   raster::BlockColors& colors) noexcept {
  for (std::uint64_t m = mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    colors.set(i, transparency::before(at(layer, i), at(colors, i)));
  }
}

constexpr BlendKernels kScalar{behind_scalar, finish_scalar, before_scalar};

}  // namespace

const BlendKernels& blend_kernels(Isa isa) noexcept {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return N_SSE4::kTable;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::kTable;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::kTable;
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return N_NEON::kTable;
#endif
    default:
      return kScalar;
  }
}

}  // namespace rastrum::transparency
#endif
