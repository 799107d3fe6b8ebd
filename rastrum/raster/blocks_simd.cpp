// What is done with 8 × 8 blocks, with Highway, compiled once per instruction set: coverage, the
// maximum and the way to 8-bit colours. Each repeats the operations of its scalar twin
// (coverage.hpp, setup.hpp, color.hpp) in the same order, so it gives the same bits.

// SSSE3 adds nothing over the scalar build that SSE4 does not; AVX3_DL nothing that these kernels
// use.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/blocks_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include <rastrum/raster/color.hpp>
#include <rastrum/raster/coverage.hpp>
#include <rastrum/raster/depth_bounds.hpp>
#include <rastrum/raster/kernels_simd.hpp>
#include <rastrum/raster/lanes-inl.hpp>
#include <rastrum/raster/shaders/srgb_lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

/// cover_8x8 from the three edges' values at the block's first sample, clamped to int32.
HWY_INLINE std::uint64_t cover_block(const std::int32_t (&base)[3], const I (&steps)[3][8 / kLanes],
                                     const std::int32_t (&b)[3]) {
  const I32 d;
  std::uint64_t mask = 0;
  for (std::size_t part = 0; part < 8 / kLanes; ++part) {
    I e0 = hn::Add(hn::Set(d, base[0]), steps[0][part]);
    I e1 = hn::Add(hn::Set(d, base[1]), steps[1][part]);
    I e2 = hn::Add(hn::Set(d, base[2]), steps[2][part]);
    const I b0 = hn::Set(d, b[0]), b1 = hn::Set(d, b[1]), b2 = hn::Set(d, b[2]);
    for (std::size_t row = 0; row < 8; ++row) {
      // A negative value of any edge sets the sign bit: outside.
      const I any = hn::Or(hn::Or(e0, e1), e2);
      std::uint8_t outside = 0;
      hn::StoreMaskBits(d, hn::Lt(any, hn::Zero(d)), &outside);
      const std::uint64_t inside = static_cast<std::uint64_t>(~outside) & ((1U << kLanes) - 1);
      mask |= inside << (row * 8 + part * kLanes);
      e0 = hn::Add(e0, b0);
      e1 = hn::Add(e1, b1);
      e2 = hn::Add(e2, b2);
    }
  }
  return mask;
}

/// Whether every edge value at the samples of blocks that the piece's box touches fits int32: with
/// differences up to 2^14 (64 px) and samples up to 8 px outside, |E| < 2 · 2^14 · (2^14 + 2^11) <
/// 2^30.
HWY_INLINE bool is_small(const Piece& p) {
  constexpr int kMost = 1 << 14;
  return max3(p.x[0], p.x[1], p.x[2]) - min3(p.x[0], p.x[1], p.x[2]) < kMost &&
         max3(p.y[0], p.y[1], p.y[2]) - min3(p.y[0], p.y[1], p.y[2]) < kMost;
}

/// The blocks of a small piece: its three edges are set up in the lanes of one vector.
template <class Hidden, class Add>
HWY_INLINE void small_cover(const Piece& p, int bx0, int by0, int bx1, int by1,
                            const Hidden& is_hidden, const Add& add) {
  const I32 d;
  const int px = bx0 * (kBlockSize * kSubpixels) + kHalfPixel;
  const int py = by0 * (kBlockSize * kSubpixels) + kHalfPixel;
  std::int32_t row_base[3], a[3], b[3];
  I steps[3][8 / kLanes];
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    a[i] = p.y[i] - p.y[j];
    b[i] = p.x[j] - p.x[i];
    const std::int32_t not_top_left = (a[i] > 0 || (a[i] == 0 && b[i] > 0)) ? 0 : 1;
    row_base[i] = (a[i] * (px - p.x[i]) + b[i] * (py - p.y[i]) - not_top_left) >> kSubpixelBits;
    for (std::size_t part = 0; part < 8 / kLanes; ++part)
      steps[i][part] =
          hn::Mul(hn::Set(d, a[i]), hn::Iota(d, static_cast<std::int32_t>(part * kLanes)));
  }
  for (int by = by0; by <= by1; ++by) {
    std::int32_t base[3] = {row_base[0], row_base[1], row_base[2]};
    for (int bx = bx0; bx <= bx1; ++bx) {
      if (!is_hidden(bx, by)) add(bx, by, cover_block(base, steps, b));
      for (int i = 0; i < 3; ++i) base[i] += a[i] * kBlockSize;
    }
    for (int i = 0; i < 3; ++i) row_base[i] += b[i] * kBlockSize;
  }
}

/// Points and lines, the scalar way; apart, so that triangles do not pay for their code.
HWY_NOINLINE std::size_t cover_other(const Piece& piece, std::uint32_t index, Rect bin,
                                     HiddenTest& hidden, Block* out) {
  const Rect box = piece_bounds(piece, bin);
  if (box.empty() || hidden.hides_piece(piece, box)) return 0;
  std::size_t n = 0;
  cover_blocks(
      piece, box, bin, [&](int bx, int by) { return hidden.hides_block(piece, bx, by); },
      [&](int bx, int by, std::uint64_t mask) {
        out[n++] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
      });
  return n;
}

std::size_t cover(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                  std::size_t capacity, DepthBounds* bounds) noexcept {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  const I32 d;
  const bool cut = bin.x1 % kBlockSize != 0 || bin.y1 % kBlockSize != 0;
  HiddenTest hidden(bounds, bin);
  std::size_t n = 0;
  for (; cursor < in.count && n + kBlocksPerBin <= capacity; ++cursor) {
    if (cursor + 6 < in.count) __builtin_prefetch(in.pieces + in.list[cursor + 6].piece);
    const std::uint32_t index = in.list[cursor].piece;
    const Piece& piece = in.pieces[index];
    if (!is_triangle(piece)) {
      n += cover_other(piece, index, bin, hidden, out + n);
      continue;
    }
    const Rect box = sample_bounds(piece.x, piece.y, bin);
    if (box.empty() || hidden.hides_piece(piece, box)) continue;
    const int bx0 = box.x0 / kBlockSize, by0 = box.y0 / kBlockSize;
    const int bx1 = (box.x1 - 1) / kBlockSize, by1 = (box.y1 - 1) / kBlockSize;
    const auto add = [&](int bx, int by, std::uint64_t mask) HWY_ATTR {
      if (cut) mask &= samples_inside(bin, bx, by);
      out[n] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
      n += mask != 0;
    };
    if (is_small(piece)) {
      small_cover(
          piece, bx0, by0, bx1, by1,
          [&](int bx, int by) HWY_ATTR { return hidden.hides_block(piece, bx, by); }, add);
      continue;
    }
    std::int32_t b[3];
    std::int64_t row_base[3], block_dx[3], block_dy[3], reach[3];
    I steps[3][8 / kLanes];
    for (int i = 0; i < 3; ++i) {
      const Edge e = edge_function(piece, i);
      b[i] = e.b;
      row_base[i] =
          e.base + std::int64_t{e.a} * (bx0 * kBlockSize) + std::int64_t{e.b} * (by0 * kBlockSize);
      block_dx[i] = std::int64_t{e.a} * kBlockSize;
      block_dy[i] = std::int64_t{e.b} * kBlockSize;
      // The largest value in a block, relative to its first sample: below 0 there, no sample is in.
      reach[i] = 7 * (std::int64_t{std::max(e.a, 0)} + std::max(e.b, 0));
      for (std::size_t part = 0; part < 8 / kLanes; ++part)
        steps[i][part] =
            hn::Mul(hn::Set(d, e.a), hn::Iota(d, static_cast<std::int32_t>(part * kLanes)));
    }
    for (int by = by0; by <= by1; ++by) {
      std::int64_t base[3] = {row_base[0], row_base[1], row_base[2]};
      for (int bx = bx0; bx <= bx1; ++bx) {
        if (base[0] + reach[0] >= 0 && base[1] + reach[1] >= 0 && base[2] + reach[2] >= 0 &&
            !hidden.hides_block(piece, bx, by)) {
          const std::int32_t clamped[3] = {
              static_cast<std::int32_t>(std::clamp(base[0], -kClamp, kClamp)),
              static_cast<std::int32_t>(std::clamp(base[1], -kClamp, kClamp)),
              static_cast<std::int32_t>(std::clamp(base[2], -kClamp, kClamp))};
          add(bx, by, cover_block(clamped, steps, b));
        }
        for (int i = 0; i < 3; ++i) base[i] += block_dx[i];
      }
      for (int i = 0; i < 3; ++i) row_base[i] += block_dy[i];
    }
  }
  return n;
}

/// The words that a row's depths make: kHalves vectors.
template <class Use>
HWY_INLINE void for_each_half(F depth, std::uint64_t low, const Use& use) {
  const F32 df;
  const U32 du;
  const hn::RebindToUnsigned<I64> du64;
  const hn::Half<U32> dh;
  depth = hn::Min(hn::IfThenElseZero(hn::Gt(depth, hn::Zero(df)), depth), hn::Set(df, 1.0F));
  const auto bits = hn::BitCast(du, depth);
  for (std::size_t h = 0; h < kHalves; ++h) {
#if HWY_MAX_BYTES >= 32
    const auto half = h == 0 ? hn::LowerHalf(dh, bits) : hn::UpperHalf(dh, bits);
#else
    const auto half =
        h == 0 ? hn::LowerHalf(dh, bits) : hn::LowerHalf(dh, hn::ConcatUpperUpper(du, bits, bits));
#endif
    use(h, hn::Or(hn::ShiftLeft<kIdBits>(hn::PromoteTo(du64, half)), hn::Set(du64, low)));
  }
}

/// The depths of row `row` of a block, column part by part: the depth formula, lane by lane.
struct DepthRows {
  F along_x[8 / kLanes];
  float y0, zy;
  int first_row;

  HWY_INLINE DepthRows(const Piece& p, const Block& block) {
    constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
    const F32 d;
    const float x0 = static_cast<float>(p.x[0]) * kPxPerSubpixel;
    y0 = static_cast<float>(p.y[0]) * kPxPerSubpixel;
    zy = p.zy;
    first_row = block.by * kBlockSize;
    for (std::size_t part = 0; part < 8 / kLanes; ++part) {
      const F column = hn::Iota(
          d, static_cast<float>(block.bx * kBlockSize) + static_cast<float>(part * kLanes));
      const F dx = hn::Sub(hn::Add(column, hn::Set(d, 0.5F)), hn::Set(d, x0));
      along_x[part] = hn::Add(hn::Set(d, p.z0), hn::Mul(hn::Set(d, p.zx), dx));
    }
  }
  HWY_INLINE F at(int row, std::size_t part) const {
    const float dy = (static_cast<float>(first_row + row) + 0.5F) - y0;
    return hn::Add(along_x[part], hn::Set(F32{}, zy * dy));
  }
};

void maximum(const Piece* pieces, const Block* blocks, std::size_t n,
             const SurfaceView& surface) noexcept {
  const I64 d64;
  for (std::size_t i = 0; i < n; ++i) {
    const Block& block = blocks[i];
    const Piece& p = pieces[block.piece];
    const DepthRows depths(p, block);
    std::uint64_t* out = surface.block(block.bx, block.by);
    for (std::uint64_t rest = block.mask; rest != 0;) {
      const int row = std::countr_zero(rest) / 8;
      const std::uint64_t row_bits = rest >> (row * 8) & 255;
      rest &= ~(std::uint64_t{255} << (row * 8));
      for (std::size_t part = 0; part < 8 / kLanes; ++part)
        for_each_half(depths.at(row, part), p.low, [&](std::size_t h, const auto word) HWY_ATTR {
          const std::size_t column = part * kLanes + h * kLanes64;
          const auto bits =
              static_cast<std::uint8_t>((row_bits >> column) & ((1U << kLanes64) - 1));
          // LoadMaskBits reads whole bytes.
          std::uint8_t mask_memory[8] = {bits};
          const auto mask = hn::LoadMaskBits(d64, mask_memory);
          auto* place = reinterpret_cast<std::int64_t*>(out + row * 8 + column);
          // Words stay below 2^63, so the signed maximum, which AVX2 has, is the maximum.
          const auto candidate = hn::IfThenElseZero(mask, hn::BitCast(d64, word));
          hn::Store(hn::Max(hn::Load(d64, place), candidate), d64, place);
        });
    }
  }
}

void words(const Piece& piece, const Block& block, std::uint64_t* out) noexcept {
  const hn::RebindToUnsigned<I64> d64;
  const DepthRows depths(piece, block);
  for (std::uint64_t rest = block.mask; rest != 0;) {
    const int row = std::countr_zero(rest) / 8;
    rest &= ~(std::uint64_t{255} << (row * 8));
    for (std::size_t part = 0; part < 8 / kLanes; ++part)
      for_each_half(depths.at(row, part), piece.low, [&](std::size_t h, const auto word) HWY_ATTR {
        hn::Store(word, d64,
                  out + static_cast<std::size_t>(row) * 8 + part * kLanes + h * kLanes64);
      });
  }
}

void masks(const Piece* pieces, Block* blocks, std::size_t n) noexcept {
  constexpr std::int64_t kClamp = std::int64_t{1} << 30;
  const I32 d;
  for (std::size_t k = 0; k < n; ++k) {
    Block& block = blocks[k];
    if (block.mask != 0) continue;
    if (!is_triangle(pieces[block.piece])) {
      block.mask = cover_8x8(pieces[block.piece], block.bx, block.by);
      continue;
    }
    std::int32_t base[3], b[3];
    I steps[3][8 / kLanes];
    for (int i = 0; i < 3; ++i) {
      const Edge e = edge_function(pieces[block.piece], i);
      b[i] = e.b;
      base[i] = static_cast<std::int32_t>(
          std::clamp(e.base + std::int64_t{e.a} * (block.bx * kBlockSize) +
                         std::int64_t{e.b} * (block.by * kBlockSize),
                     -kClamp, kClamp));
      for (std::size_t part = 0; part < 8 / kLanes; ++part)
        steps[i][part] =
            hn::Mul(hn::Set(d, e.a), hn::Iota(d, static_cast<std::int32_t>(part * kLanes)));
    }
    block.mask = cover_block(base, steps, b);
  }
}

HWY_INLINE hn::Vec<U32> quantize_lanes(F v) {
  const F32 d;
  const F low = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
  const F clamped = hn::Min(low, hn::Set(d, 1.0F));
  return hn::BitCast(U32{}, hn::NearestInt(hn::Mul(clamped, hn::Set(d, 255.0F))));
}

HWY_INLINE hn::Vec<U32> pack(F r, F g, F b) {
  const auto red_green = hn::Or(quantize_lanes(r), hn::ShiftLeft<8>(quantize_lanes(g)));
  return hn::Or(red_green, hn::ShiftLeft<16>(quantize_lanes(b)));
}

void store_opaque(const BlockColors& colors, std::uint64_t covered, Rgba8 background, Rgba8* out,
                  std::ptrdiff_t stride) noexcept {
  const U32 d;
  const auto behind = hn::Set(d, std::bit_cast<std::uint32_t>(background));
  for (int row = 0; row < kBlockSize; ++row)
    for (std::size_t part = 0; part < 8; part += kLanes) {
      const std::size_t i = static_cast<std::size_t>(row) * 8 + part;
      const F32 df;
      const auto rgb =
          pack(hn::Load(df, colors.r + i), hn::Load(df, colors.g + i), hn::Load(df, colors.b + i));
      const auto pixel = hn::Or(rgb, hn::Set(d, 0xff000000U));
      hn::StoreU(hn::IfThenElse(lane_mask(covered >> i), pixel, behind), d,
                 reinterpret_cast<std::uint32_t*>(out + row * stride + static_cast<int>(part)));
    }
}

template <bool kLinear>
void store_over(const BlockColors& colors, std::uint64_t covered, const Backdrop& backdrop,
                Rgba8* out, std::ptrdiff_t stride) {
  const F32 d;
  const U32 du;
  const F one = hn::Set(d, 1.0F);
  const auto empty = hn::Set(du, std::bit_cast<std::uint32_t>(backdrop.empty));
  for (int row = 0; row < kBlockSize; ++row)
    for (std::size_t part = 0; part < 8; part += kLanes) {
      const std::size_t i = static_cast<std::size_t>(row) * 8 + part;
      const F front = hn::Load(d, colors.a + i), through = hn::Sub(one, front);
      const auto over = [&](F color, float behind) HWY_ATTR {
        return hn::Add(color, hn::Mul(hn::Set(d, behind), through));
      };
      const F a = over(front, backdrop.color.w);
      const auto divides = hn::And(hn::Gt(a, hn::Zero(d)), hn::Ne(a, one));
      const F scale = hn::IfThenElse(divides, hn::Div(one, a), one);
      const auto straight = [&](const float* channel, float behind) HWY_ATTR {
        const F c = hn::Mul(over(hn::Load(d, channel + i), behind), scale);
        if constexpr (kLinear) return srgb_lanes(d, c);
        return c;
      };
      const auto rgb =
          pack(straight(colors.r, backdrop.color.x), straight(colors.g, backdrop.color.y),
               straight(colors.b, backdrop.color.z));
      const auto pixel = hn::Or(rgb, hn::ShiftLeft<24>(quantize_lanes(a)));
      hn::StoreU(hn::IfThenElse(lane_mask(covered >> i), pixel, empty), du,
                 reinterpret_cast<std::uint32_t*>(out + row * stride + static_cast<int>(part)));
    }
}

void store_blended(const BlockColors& colors, std::uint64_t covered, const Backdrop& backdrop,
                   Rgba8* out, std::ptrdiff_t stride) noexcept {
  (backdrop.linear ? store_over<true> : store_over<false>)(colors, covered, backdrop, out, stride);
}

std::uint64_t lowest(const std::uint64_t* words) noexcept {
  // Words stay below 2^63, so they compare as signed numbers do.
  const I64 d;
  const auto* in = reinterpret_cast<const std::int64_t*>(words);
  auto least = hn::Load(d, in);
  for (std::size_t i = kLanes64; i < 64; i += kLanes64) least = hn::Min(least, hn::Load(d, in + i));
  HWY_ALIGN std::int64_t lanes[kLanes64];
  hn::Store(least, d, lanes);
  return static_cast<std::uint64_t>(*std::min_element(lanes, lanes + kLanes64));
}

std::uint64_t covered(const std::uint64_t* words) noexcept {
  const hn::RebindToUnsigned<I64> d;
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < 64; i += kLanes64) {
    std::uint8_t empty = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, words + i), hn::Zero(d)), &empty);
    mask |= static_cast<std::uint64_t>(~empty & ((1U << kLanes64) - 1)) << i;
  }
  return mask;
}

void fill(Kernels& table) {
  table.cover = cover;
  table.masks = masks;
  table.words = words;
  table.maximum = maximum;
  table.lowest = lowest;
  table.covered = covered;
  table.store_opaque = store_opaque;
  table.store_blended = store_blended;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
namespace rastrum::raster {

bool fill_block_kernels(Isa isa, Kernels& table) noexcept {
  switch (isa) {
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return N_SSE4::fill(table), true;
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::fill(table), true;
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::fill(table), true;
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return N_NEON::fill(table), true;
#endif
    default:
      return false;
  }
}

}  // namespace rastrum::raster
#endif
