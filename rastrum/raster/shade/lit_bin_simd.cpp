// The lit shaders of a bin whose triangles are small, compiled once per instruction set. The
// triangles that the bin's pixels see are numbered in the order in which they are met, kLanes of
// them are a group, and pixels are put together by group. So each triangle is set up once, in full
// lanes, and while a group is shaded the vertices of the next one and the indices of those behind
// it come from memory. What is lit goes back to its pixel.
//
// The bits are those of lit_simd.cpp, which does this for one block after the other.

#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/lit_bin_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit_bin.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_lanes-inl.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::CappedTag<float, RASTRUM_LIT_LANES>;
using I32 = hn::RebindToSigned<F32>;
using F = hn::Vec<F32>;
using I = hn::Vec<I32>;
constexpr std::size_t kLanes = RASTRUM_LIT_LANES;
static_assert(kLanes >= LitBin::kLeastOfGroup && kLanes <= 16);

#include <rastrum/raster/kernels/lane_math-inl.hpp>

#include <rastrum/raster/kernels/lookups-inl.hpp>
#include <rastrum/raster/shade/lights-inl.hpp>

#include <rastrum/raster/shade/lit_light-inl.hpp>  // after the lights

#include <rastrum/raster/shade/seen_triangles-inl.hpp>

#include <rastrum/raster/shade/lit_seen-inl.hpp>  // after the triangles
#undef RASTRUM_LANES

/// Vectors of pixels that are lit in one go: lighting is one long chain, of which the processor
/// overlaps several.
constexpr std::size_t kBatch = 16;
/// Groups whose indices are asked for before they are read.
constexpr std::size_t kAhead = 3;

HWY_INLINE std::uint64_t covered_of(const std::uint64_t* keys) {
  const hn::CappedTag<std::uint64_t, 8> d;
  constexpr std::size_t kStep = hn::MaxLanes(hn::CappedTag<std::uint64_t, 8>());
  std::uint64_t empty = 0;
  for (std::size_t i = 0; i < 64; i += kStep) {
    std::uint8_t bits = 0;
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, keys + i), hn::Zero(d)), &bits);
    empty |= (std::uint64_t{bits} & ((1U << kStep) - 1)) << i;
  }
  return ~empty;
}

/// Numbers the triangles and finds the runs of pixels. Returns how many there are of each.
struct Found {
  std::size_t triangles = 0, runs = 0;
};
HWY_INLINE Found find_runs(const FrameGeometry& frame, const BinSurface& bin, LitBin& own) {
  std::memset(own.table, 0, sizeof own.table);
  std::memset(own.end_of, 0, LitBin::kPixels / kLanes * sizeof own.end_of[0]);
  own.low[0] = 0;  // no key has that
  std::uint32_t count = 0, n = 0;
  const Rect image{0, 0, frame.width, frame.height};
  for (int row = 0; row < block_rows(bin.rect); ++row)
    for (int column = 0; column < block_columns(bin.rect); ++column) {
      const std::uint64_t* const keys = bin.block(column, row);
      std::uint64_t covered = covered_of(keys);
      const int bx = bin.rect.x0 / kBlockSize + column, by = bin.rect.y0 / kBlockSize + row;
      if ((bx + 1) * kBlockSize > image.x1 || (by + 1) * kBlockSize > image.y1)
        covered &= samples_inside(image, bx, by);
      std::uint64_t starts = SeenTriangles::run_starts(keys, covered);
      std::uint64_t lasts =
          covered & (starts >> 1 | ~(covered >> 1) | std::uint64_t{0x8080808080808080});
      const auto block = static_cast<std::uint32_t>(row * 8 + column) * 64;
      for (; starts != 0; starts &= starts - 1, lasts &= lasts - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(starts));
        const std::uint32_t more = static_cast<std::uint32_t>(std::countr_zero(lasts)) - i;
        const std::uint64_t low = keys[i] & kIdMask;
        std::uint16_t& entry = own.table[low % std::size(own.table)];
        // Without a branch, which nobody could predict, and of which compilers make one of `?:`. A
        // triangle may be there twice: what the table forgets costs only time.
        const std::uint32_t is_new = own.low[entry] != low ? 1 : 0;
        const std::uint32_t number = entry ^ ((entry ^ count) & (0U - is_new));
        own.low[count] = low;
        count += is_new;
        entry = static_cast<std::uint16_t>(number);
        own.runs[n++] = (block + i) | number << 12 | more << 24;
        own.end_of[number / kLanes] += more + 1;
      }
    }
  return {count, n};
}

/// Puts the pixels of each group together.
HWY_INLINE void sort_runs(const Found& found, LitBin& own) {
  std::uint32_t next = 0;
  for (std::size_t g = 0; g * kLanes < found.triangles; ++g) {
    const std::uint32_t pixels = own.end_of[g];
    own.begin_of[g] = own.end_of[g] = next;
    next += (pixels + 7 + kLanes - 1) / kLanes * kLanes;
  }
  const hn::CappedTag<std::uint16_t, 8> d;
  const auto after = hn::Iota(d, 0);
  for (std::size_t i = 0; i < found.runs; ++i) {
    const std::uint32_t run = own.runs[i];
    const std::uint32_t number = run >> 12 & 0xFFF;
    const auto first = static_cast<std::uint16_t>((run & 0xFFF) | number % kLanes << 12);
    std::uint32_t& at = own.end_of[number / kLanes];
    // Eight are written, whatever their number: the next run, or nothing, stands behind them.
    hn::StoreU(hn::Add(hn::Set(d, first), after), d, own.fragments + at);
    at += (run >> 24) + 1;
  }
}

struct Group {
  LitSources from;
  LitLanes lanes;
};

/// Vectors of pixels that are to be lit.
struct alignas(64) Batch {
  float px[kBatch][kLanes], py[kBatch][kLanes];
  float n[kBatch][3][kLanes], base[kBatch][3][kLanes];
  std::int32_t place[kBatch][kLanes];  ///< of their colours, counted in float from LitBin::colors
  std::size_t count = 0;
};
constexpr int kFloatsOfBlock = sizeof(BlockColors) / sizeof(float);

HWY_INLINE void store(const V3& v, float (&to)[3][kLanes]) {
  const F32 d;
  hn::Store(v.x, d, to[0]);
  hn::Store(v.y, d, to[1]);
  hn::Store(v.z, d, to[2]);
}
HWY_INLINE V3 load(const float (&from)[3][kLanes]) {
  const F32 d;
  return {hn::Load(d, from[0]), hn::Load(d, from[1]), hn::Load(d, from[2])};
}

HWY_INLINE F depths_at(const BinSurface& bin, const std::int32_t (&place)[kLanes]) {
  HWY_ALIGN float depth[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const int block = place[i] / kFloatsOfBlock;
    depth[i] = block == static_cast<int>(LitBin::kBlocks)
                   ? 1.0F
                   : depth_of_key(bin.block(block % 8, block / 8)[place[i] % kFloatsOfBlock]);
  }
  return hn::Load(F32{}, depth);
}

template <LitModel kModel, bool kFixed>
HWY_NOINLINE void light_batch(const LitScene& scene, const BinSurface& bin, bool colored,
                              const Batch& batch, BlockColors* colors) {
  const F32 d;
  const ViewRays rays = scene.rays;
  auto* const to = reinterpret_cast<float*>(colors);
  V3 base = set(kDefaultBase);
  for (std::size_t v = 0; v < batch.count; ++v) {
    const F px = hn::Load(d, batch.px[v]), py = hn::Load(d, batch.py[v]);
    if (colored) base = load(batch.base[v]);
    const V3 n = kModel != LitModel::flat ? load(batch.n[v]) : base;
    V3 c;
    if constexpr (kFixed) {
      c = light(kModel, rays, px, py, n, base);
    } else {
      const F depth = scene.lights->has_places ? depths_at(bin, batch.place[v]) : set(1);
      c = light_by(*scene.lights, kModel, rays, px, py, depth, n, base);
    }
    HWY_ALIGN float lit[3][kLanes];
    store(c, lit);
    for (std::size_t i = 0; i < kLanes; ++i) {
      float* const pixel = to + batch.place[v][i];
      pixel[0] = lit[0][i];
      pixel[64] = lit[1][i];
      pixel[128] = lit[2][i];
    }
  }
}

template <LitModel kModel>
void shade_model(const LitScene& scene, const FrameGeometry& frame, const BinSurface& bin,
                 LitBin& own) {
  constexpr bool kNormals = kModel != LitModel::flat;
  constexpr bool kLit = kModel == LitModel::lambert || kModel == LitModel::phong;
  const bool colored = kModel != LitModel::normal && scene.colored;
  const Found found = find_runs(frame, bin, own);
  sort_runs(found, own);
  const std::size_t group_count = (found.triangles + kLanes - 1) / kLanes;
  const auto triangles_of = [&](std::size_t g)
                                HWY_ATTR { return std::min(kLanes, found.triangles - g * kLanes); };
  Group groups[2];
  Batch batch;
  DrawOfTriangle of(scene, frame);
  const auto prefetch = [&](std::size_t g) HWY_ATTR {
    if (g >= group_count) return;
    const std::size_t n = triangles_of(g);
    for (std::size_t i = 0; i < n; ++i) of.prefetch(own.low[g * kLanes + i]);
  };
  const auto find_sources = [&](std::size_t g) HWY_ATTR {
    if (g >= group_count) return;
    Group& group = groups[g % 2];
    const std::size_t n = triangles_of(g);
    find_all_sources(of, own.low + g * kLanes, n, kNormals, group.from, group.lanes);
    prefetch_sources(group.from, n, kNormals);
  };
  const auto light = [&]() HWY_ATTR {
    if (kLit && scene.lights != nullptr)
      light_batch<kModel, !kLit>(scene, bin, colored, batch, own.colors);
    else
      light_batch<kModel, true>(scene, bin, colored, batch, own.colors);
    batch.count = 0;
  };
  for (std::size_t g = 0; g < kAhead; ++g) prefetch(g);
  find_sources(0);
  const F32 d;
  const I32 di;
  const hn::Rebind<std::uint16_t, I32> d16;
  const auto bits = [&](I v, int shift, int mask) HWY_ATTR {
    return hn::And(hn::ShiftRightSame(v, shift), hn::Set(di, mask));
  };
  for (std::size_t g = 0; g < group_count; ++g) {
    prefetch(g + kAhead);
    find_sources(g + 1);
    Group& group = groups[g % 2];
    LitLanes& t = group.lanes;
    fetch_triangles(group.from, triangles_of(g), kNormals, t);
    for (std::size_t i = own.begin_of[g]; i < own.end_of[g]; i += kLanes) {
      const I fragment = hn::PromoteTo(di, hn::Load(d16, own.fragments + i));
      const I lane = bits(fragment, 12, static_cast<int>(kLanes) - 1);
      const I x = hn::Or(bits(fragment, 3, 0x38), bits(fragment, 0, 7));
      const I y = hn::Or(bits(fragment, 6, 0x38), bits(fragment, 3, 7));
      const F px = hn::ConvertTo(d, hn::Add(x, hn::Set(di, bin.rect.x0))) + set(0.5F);
      const F py = hn::ConvertTo(d, hn::Add(y, hn::Set(di, bin.rect.y0))) + set(0.5F);
      static_assert(kFloatsOfBlock == 256);
      I place = hn::Or(hn::ShiftLeft<8>(bits(fragment, 6, 63)), bits(fragment, 0, 63));
      const std::size_t rest = own.end_of[g] - i;
      if (rest < kLanes)  // behind the last pixel stands anything
        place = hn::IfThenElse(hn::FirstN(di, rest), place,
                               hn::Set(di, int{LitBin::kBlocks} * kFloatsOfBlock));
      const Lookup look{hn::IndicesFromVec(d, lane)};
      const CornerWeights w = look.weights(t, px, py);
      if (batch.count == kBatch) light();
      const std::size_t v = batch.count++;
      hn::Store(px, d, batch.px[v]);
      hn::Store(py, d, batch.py[v]);
      hn::Store(place, di, batch.place[v]);
      if constexpr (kNormals) store(look.sum(w, t.normal), batch.n[v]);
      if (colored) store(look.sum(w, t.color) * (set(1) / (w.b0 + w.b1 + w.b2)), batch.base[v]);
      for (std::uint64_t exact = t.exact; exact != 0; exact &= exact - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(exact));
        const auto mine = hn::RebindMask(d, hn::Eq(lane, hn::Set(di, static_cast<int>(k))));
        if (bits_of(mine) == 0) continue;
        const WeightPlanes planes = planes_of(frame, kIdMask - own.low[g * kLanes + k]);
        const CornerWeights e = exact_weights(planes, batch.px[v], batch.py[v]);
        const auto corners = [&](const float(&of_lane)[3][3][kLanes], Vec3(&to)[3]) HWY_ATTR {
          for (int c = 0; c < 3; ++c)
            to[c] = {of_lane[c][0][k], of_lane[c][1][k], of_lane[c][2][k]};
        };
        Vec3 values[3];
        if constexpr (kNormals) {
          corners(t.normal, values);
          store(choose(mine, e.sum(values), load(batch.n[v])), batch.n[v]);
        }
        if (!colored) continue;
        corners(t.color, values);
        const V3 base = e.sum(values) * (set(1) / (e.b0 + e.b1 + e.b2));
        store(choose(mine, base, load(batch.base[v])), batch.base[v]);
      }
    }
  }
  light();
}

void shade(const LitShading& lit, const FrameGeometry& frame, const BinSurface& bin,
           LitBin& own) noexcept {
  const LitScene& scene = *lit.scene;
  switch (lit.model) {
    case LitModel::flat:
      return shade_model<LitModel::flat>(scene, frame, bin, own);
    case LitModel::normal:
      return shade_model<LitModel::normal>(scene, frame, bin, own);
    case LitModel::lambert:
      return shade_model<LitModel::lambert>(scene, frame, bin, own);
    default:
      return shade_model<LitModel::phong>(scene, frame, bin, own);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

namespace {

bool are_different(std::uint64_t a, std::uint64_t b) {
  return ((a ^ b) & kIdMask) != 0;
}

/// Whether triangles are so small that a block sees many: then two pixels of it that lie apart
/// mostly see two.
bool is_fine(const BinSurface& bin) {
  int pairs = 0, differ = 0;
  for (int row = 0; row < block_rows(bin.rect); ++row)
    for (int column = 0; column < block_columns(bin.rect); ++column) {
      const std::uint64_t* const keys = bin.block(column, row);
      const std::uint64_t a = keys[8 * 1 + 1], b = keys[8 * 6 + 6];
      if (a == 0 || b == 0) continue;
      ++pairs;
      differ += are_different(a, b) ? 1 : 0;
    }
  return differ >= 4 && differ * 4 >= pairs * 3;
}

using ShadeBin = void (*)(const LitShading&, const FrameGeometry&, const BinSurface&, LitBin&);
constexpr ShadeBin kShadeBin[] = RASTRUM_BY_ISA(shade, nullptr);

}  // namespace

bool suits_lit_bin(Isa isa, const LitShading& lit, const BinSurface& bin) noexcept {
  const bool interpolates = lit.model == LitModel::normal || lit.model == LitModel::lambert ||
                            lit.model == LitModel::phong ||
                            (lit.model == LitModel::flat && lit.scene->colored);
  return interpolates && kShadeBin[static_cast<std::size_t>(isa)] != nullptr && is_fine(bin);
}

void shade_lit_bin(Isa isa, const LitShading& lit, const FrameGeometry& frame,
                   const BinSurface& bin, LitBin& own) noexcept {
  kShadeBin[static_cast<std::size_t>(isa)](lit, frame, bin, own);
}

}  // namespace rastrum::raster
#endif
