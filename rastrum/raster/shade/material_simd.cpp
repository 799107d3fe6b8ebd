// SPDX-License-Identifier: BSD-3-Clause
// Materials in lanes, compiled once per instruction set, in three steps of whole vectors of pixels.
// A block's triangles are set up one a lane (material_seen-inl.hpp) and interpolated into a
// surface; each material applies its textures; then all is lit. Alpha goes triangle by triangle, in
// plain loops that compilers vectorize.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/material_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#define RASTRUM_MOST_LANES 16  // a pixel or a triangle a lane
#include <rastrum/raster/shade/material_bin-inl.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>
#include <rastrum/raster/shade/material_light-inl.hpp>
#include <rastrum/raster/shade/material_seen-inl.hpp>
#include <rastrum/raster/shade/texture_pixels-inl.hpp>
#include <rastrum/raster/surface/seen_bin.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster::HWY_NAMESPACE {
namespace {  // several sources have an N_AVX2

constexpr std::uint64_t kAllLanes = (std::uint64_t{1} << kLanes) - 1;

HWY_INLINE F load(const float* p) {
  return hn::Load(F32{}, p);
}
/// The surfaces of 64 fragments, for lighting.
struct alignas(64) Surface {
  enum Channel {
    kBaseR,
    kBaseG,
    kBaseB,
    kNormalX,
    kNormalY,
    kNormalZ,  ///< unit, towards the viewer
    kMetallic,
    kRoughness,
    kOcclusion,
    kEmissiveR,
    kEmissiveG,
    kEmissiveB,
    kUnlit,  ///< 1: the base colour is the result
    kChannels,
    // The classic shader's, in the same places.
    kSpecular = kMetallic,
    kSixteenths = kRoughness,
    kEmission = kOcclusion,
    kTexelR = kEmissiveR
  };
  float channel[kChannels][64];
  float side[64];  ///< −1: the triangle is seen from behind; else 1
};

/// Lights 64 fragments; results outside of the covered ones do not matter.
template <bool kFixed>
HWY_NOINLINE void light_block(const MaterialView& scene, const Surface& s,
                              const VisibleBlock& block, bool linear, BlockColors& out) {
  const ViewRays& rays = scene.rays;
  const auto& c = s.channel;
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((block.covered >> i & kAllLanes) == 0) continue;
    const Points at(block, i);
    const V3 base = load(c[Surface::kBaseR] + i, c[Surface::kBaseG] + i, c[Surface::kBaseB] + i);
    const LitSurface lit{
        base,
        load(c[Surface::kNormalX] + i, c[Surface::kNormalY] + i, c[Surface::kNormalZ] + i),
        load(c[Surface::kMetallic] + i),
        load(c[Surface::kRoughness] + i),
        load(c[Surface::kOcclusion] + i),
        load(c[Surface::kEmissiveR] + i, c[Surface::kEmissiveG] + i, c[Surface::kEmissiveB] + i)};
    const auto unlit = load(c[Surface::kUnlit] + i) > set(0);
    V3 color;
    if constexpr (kFixed) {
      color = light(rays, lit, at.px, at.py);
    } else {
      alignas(64) float depth[kLanes];
      for (std::size_t k = 0; k < kLanes; ++k) depth[k] = depth_of_key(block.keys[i + k]);
      color = light_by(*scene.lights, rays, lit, at.px, at.py, load(depth));
    }
    store(written(choose(unlit, base, color), linear), out.r + i, out.g + i, out.b + i);
  }
}

/// light_block for the classic shader.
HWY_NOINLINE void light_classic_block(const MaterialView& scene, const Surface& s,
                                      const VisibleBlock& block, BlockColors& out) {
  const auto& c = s.channel;
  for (std::size_t i = 0; i < 64; i += kLanes) {
    if ((block.covered >> i & kAllLanes) == 0) continue;
    const Points at(block, i);
    const auto load3 = [&](int k) HWY_ATTR { return load(c[k] + i, c[k + 1] + i, c[k + 2] + i); };
    const ClassicSurface lit{load3(Surface::kBaseR),          load3(Surface::kNormalX),
                             load(c[Surface::kSpecular] + i), load(c[Surface::kSixteenths] + i),
                             load(c[Surface::kEmission] + i), load3(Surface::kTexelR)};
    alignas(64) float depth[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) depth[k] = depth_of_key(block.keys[i + k]);
    const V3 color = classic_light(*scene.lights, scene.rays, lit, at.px, at.py, load(depth));
    const auto unlit = load(c[Surface::kUnlit] + i) > set(0);
    store(choose(unlit, lit.base * lit.texel, color), out.r + i, out.g + i, out.b + i);
  }
}

/// The materials of a block's triangles, numbered.
struct BlockMaterials {
  std::size_t count = 0;
  const BoundMaterial* material[64];
  alignas(64) std::uint8_t of_pixel[64];

  /// A material's number, a new one if the block has not seen it.
  HWY_INLINE std::uint8_t number_of(const BoundMaterial* own) {
    std::size_t m = 0;
    while (m < count && material[m] != own) ++m;
    material[m] = own;
    count = std::max(count, m + 1);
    return static_cast<std::uint8_t>(m);
  }
};

/// Finds the materials of a block's pixels in a bin that is set up.
HWY_INLINE void find_materials(const MaterialView& scene, const SeenBin& bin,
                               const std::uint16_t* place, std::uint64_t covered,
                               BlockMaterials& out) {
  if (scene.materials.size() == 1) {
    (void)out.number_of(scene.materials.data());
    return;
  }
  std::memset(out.of_pixel, 0, sizeof out.of_pixel);
  std::uint32_t last = ~std::uint32_t{0};
  std::uint8_t number = 0;
  for (; covered != 0; covered &= covered - 1) {
    const int i = std::countr_zero(covered);
    if (const std::uint32_t own = bin.material[place[i]]; own != last) {
      number = out.number_of(&scene.materials[own]);
      last = own;
    }
    out.of_pixel[i] = number;
  }
}

struct SeenMaterials {
  static constexpr std::size_t kGroups = 64 / kLanes;
  SeenTriangles seen;
  MaterialLanes lanes[kGroups];

  HWY_INLINE SeenMaterials(const MaterialView& scene, const FrameGeometry& frame,
                           const VisibleBlock& block, BlockMaterials& out) {
    find_anew(block.keys, block.covered, seen);
    MaterialOfTriangle finder(scene, frame);
    for (std::size_t i = 0; i < seen.count; ++i) finder.prefetch(seen.low[i]);
    for (std::size_t g = 0; g < groups(); ++g) {
      const std::uint64_t* const low = seen.low + g * kLanes;
      const std::size_t n = std::min(kLanes, seen.count - g * kLanes);
      MaterialSources from;
      find_sources(finder, low, n, from, lanes[g]);
      set_triangles(finder, low, n, n, from, lanes[g]);
    }
    std::uint8_t number[64];
    for (std::size_t i = 0; i < seen.count; ++i)
      number[i] = out.number_of(lanes[i / kLanes].material[i % kLanes]);
    if (out.count == 1) return;
    for (int i = 0; i < 64; ++i) out.of_pixel[i] = number[seen.place[i]];
  }
  [[nodiscard]] std::size_t groups() const { return (seen.count + kLanes - 1) / kLanes; }
};

/// Calls use(lanes, lookup, `mask` of the pixels with triangles in these lanes, first) for the
/// covered pixels.
template <class Use>
HWY_INLINE void for_each_vector(const VisibleBlock& block, const SeenMaterials& of,
                                const Use& use) {
  for_each_group<MaterialLookup>(of.seen.place, of.seen.count, block.covered,
                                 [&](std::size_t first, std::size_t g, const MaterialLookup& look,
                                     auto mine) HWY_ATTR { use(of.lanes[g], look, mine, first); });
}

/// Not a masked store: AVX2's are slow on Zen 4.
template <class Mask>
HWY_INLINE void blend(F v, Mask mask, float* to) {
  hn::Store(choose(mask, v, load(to)), F32{}, to);
}
template <class Mask>
HWY_INLINE void blend(const V3& v, Mask mask, float* x, float* y, float* z) {
  blend(v.x, mask, x);
  blend(v.y, mask, y);
  blend(v.z, mask, z);
}

/// Interpolates vertex colours, normals without normal maps and, if `textured`, texture coordinates
/// at the pixels `mine` of first to first + kLanes, whose triangles `from` has.
template <class From>
HWY_INLINE void interpolate(const MaterialView& scene, const VisibleBlock& block, const From& from,
                            hn::Mask<F32> mine, std::size_t first, bool textured, Coordinates& at,
                            Surface& out) {
  const ViewRays& rays = scene.rays;
  const Points points(block, first);
  const WidePoints wide_points(block, first);
  const LaneShares shares(from, wide_points.x, wide_points.y);
  const V3 face = from.face();
  const V3 away = set(rays.d) + set(rays.dx) * points.px + set(rays.dy) * points.py;
  const F side = choose(dot(face, away) > set(0), set(-1), set(1));
  blend(side, mine, out.side + first);
  const V3 seen = face * side;
  V3 n = seen;
  if (from.some_normals()) {  // turned
    V3 normals[3];
    from.normals(normals);
    const V3 v = shares.at(normals);
    const F square = dot(v, v);
    const V3 own = choose(square > set(0), v * (set(1) / square_root(square)), seen);
    const V3 smooth = own * choose(dot(own, seen) < set(0), set(-1), set(1));
    n = choose(from.with_normals(), smooth, seen);
  }
  const auto channel = [&](int c) HWY_ATTR { return out.channel[c] + first; };
  blend(n, mine, channel(Surface::kNormalX), channel(Surface::kNormalY),
        channel(Surface::kNormalZ));
  if (from.some_colors()) {
    V3 colors[3];
    from.colors(colors);
    blend(shares.at(colors), hn::And(mine, from.with_colors()), channel(Surface::kBaseR),
          channel(Surface::kBaseG), channel(Surface::kBaseB));
  }
  if (!textured) return;
  using P = PlaneTable<kLanes>;
  const WidePair pq0 = from.template planes<P::kP>();
  const WidePair r0p1 = from.template planes<P::kP + 2>();
  const WidePair q1r1 = from.template planes<P::kP + 4>();
  const WidePair pq2 = from.template planes<P::kP + 6>();
  const Wide p = pq0.first + r0p1.second + pq2.first;
  const Wide q = pq0.second + q1r1.first + pq2.second;
  V3 u, v;
  from.coordinates(u, v);
  const auto coordinate = [&](const V3& a, float* value, float* dx, float* dy) HWY_ATTR {
    const F offset = shares.offset(a.y, a.z);
    blend(a.x + offset, mine, value + first);
    const Wide more = wide(offset), wide1 = wide(a.y), wide2 = wide(a.z);
    const Wide px = r0p1.second * wide1 + pq2.first * wide2;
    const Wide qy = q1r1.first * wide1 + pq2.second * wide2;
    blend(rounded((px - more * p) * shares.scale), mine, dx + first);
    blend(rounded((qy - more * q) * shares.scale), mine, dy + first);
  };
  coordinate(u, at.u, at.u_dx, at.u_dy);
  coordinate(v, at.v, at.v_dx, at.v_dy);
}

HWY_INLINE hn::Mask<F32> of_material(const BlockMaterials& of, std::size_t m, std::size_t first) {
  if (of.count == 1) return mask_of(kAllLanes);
  const I own = hn::Set(I32{}, static_cast<int>(m));
  return hn::RebindMask(F32{}, hn::Eq(numbers_of(of.of_pixel, first), own));
}
HWY_INLINE std::uint64_t pixels_of(const VisibleBlock& block, const BlockMaterials& of,
                                   std::size_t m) {
  if (of.count == 1) return block.covered;
  std::uint64_t own = 0;
  for (std::size_t first = 0; first < 64; first += kLanes)
    own |= bits_of(of_material(of, m, first)) << first;
  return own & block.covered;
}

/// Sets the values of material `m` with its textures, except for its normal map. `own_base`: base
/// colours come from elsewhere.
HWY_INLINE void set_material(const VisibleBlock& block, const BlockMaterials& of, std::size_t m,
                             const Coordinates& at, bool own_base, bool classic, Surface& out) {
  const BoundMaterial& material = *of.material[m];
  const std::uint64_t pixels = pixels_of(block, of, m);
  const auto put = [&](F v, std::size_t first, int c)
                       HWY_ATTR { blend(v, of_material(of, m, first), out.channel[c] + first); };
  const auto put3 = [&](const V3& v, std::size_t first, int c) HWY_ATTR {
    put(v.x, first, c);
    put(v.y, first, c + 1);
    put(v.z, first, c + 2);
  };
  for_wanted(pixels, [&](std::size_t first) HWY_ATTR {
    put(set(material.unlit ? 1.0F : 0.0F), first, Surface::kUnlit);
    if (classic) {
      put(set(material.classic.specular), first, Surface::kSpecular);
      put(set(material.sixteenths), first, Surface::kSixteenths);
      put(set(material.classic.emission), first, Surface::kEmission);
      put3(set(Vec3{1, 1, 1}), first, Surface::kTexelR);
      return;
    }
    put(set(material.metallic), first, Surface::kMetallic);
    put(set(material.roughness), first, Surface::kRoughness);
    put(set(1), first, Surface::kOcclusion);
    put3(set(material.emission), first, Surface::kEmissiveR);
  });
  BlockTexels texels;
  const auto with = [&](const MipChain* chain, const auto& use) HWY_ATTR {
    if (chain == nullptr) return;
    sample(*chain, at, pixels, texels);
    for_wanted(pixels, [&](std::size_t first) HWY_ATTR { use(first, texels.at(first)); });
  };
  with(material.metallic_roughness, [&](std::size_t first, const V3& texel) HWY_ATTR {
    put(set(material.roughness) * texel.y, first, Surface::kRoughness);
    put(set(material.metallic) * texel.z, first, Surface::kMetallic);
  });
  with(material.occlusion, [&](std::size_t first, const V3& texel) HWY_ATTR {
    put(set(1) + set(material.occlusion_strength) * (texel.x - set(1)), first, Surface::kOcclusion);
  });
  with(material.emissive, [&](std::size_t first, const V3& texel) HWY_ATTR {
    put3(set(material.emission) * texel, first, Surface::kEmissiveR);
  });
  with(own_base ? nullptr : material.base_color, [&](std::size_t first, const V3& texel) HWY_ATTR {
    if (classic) return put3(texel, first, Surface::kTexelR);
    const auto base = [&](int c) HWY_ATTR { return load(out.channel[c] + first); };
    put3(V3{base(Surface::kBaseR), base(Surface::kBaseG), base(Surface::kBaseB)} * texel, first,
         Surface::kBaseR);
  });
}

/// Base colours of materials; those of vertices replace them later.
HWY_INLINE void set_base(const VisibleBlock& block, const BlockMaterials& of, Surface& out) {
  for (std::size_t m = 0; m < of.count; ++m) {
    const Vec4 base = of.material[m]->base;
    for (std::size_t first = 0; first < 64; first += kLanes) {
      blend(set(Vec3{base.x, base.y, base.z}), of_material(of, m, first),
            out.channel[Surface::kBaseR] + first, out.channel[Surface::kBaseG] + first,
            out.channel[Surface::kBaseB] + first);
    }
  }
}

/// Bends normals by the normal maps of their materials.
HWY_NOINLINE void bend(const VisibleBlock& block, const SeenMaterials& triangles,
                       const BlockMaterials& of, const Coordinates& at, Surface& out) {
  BlockTexels texels;
  struct alignas(64) {
    float r[64], g[64], b[64];
  } map;
  alignas(64) float strength[64] = {};
  alignas(64) std::uint8_t is_bent[64] = {};
  for (std::size_t m = 0; m < of.count; ++m) {
    const BoundMaterial& material = *of.material[m];
    if (material.normal == nullptr) continue;
    const std::uint64_t pixels = pixels_of(block, of, m);
    sample(*material.normal, at, pixels, texels);
    for_wanted(pixels, [&](std::size_t first) HWY_ATTR {
      const auto own = of_material(of, m, first);
      blend(texels.at(first), own, map.r + first, map.g + first, map.b + first);
      blend(set(material.normal_scale), own, strength + first);
    });
    for (std::uint64_t rest = pixels; rest != 0; rest &= rest - 1)
      is_bent[std::countr_zero(rest)] = 1;
  }
  for_each_vector(
      block, triangles,
      [&](const MaterialLanes& t, const MaterialLookup& look, auto mine, std::size_t first)
          HWY_ATTR {
            const auto bent =
                hn::RebindMask(F32{}, hn::Eq(numbers_of(is_bent, first), hn::Set(I32{}, 1)));
            const auto own = hn::And(mine, bent);
            if (bits_of(own) == 0) return;
            float* const nx = out.channel[Surface::kNormalX] + first;
            float* const ny = out.channel[Surface::kNormalY] + first;
            float* const nz = out.channel[Surface::kNormalZ] + first;
            const V3 n = load(nx, ny, nz);
            // TangentFrame::bend. A bump in front is a dent from behind, so tangents turn with the
            // normal.
            const F scale = load(strength + first) * load(out.side + first);
            const F x = (load(map.r + first) * set(2) - set(1)) * scale;
            const F y = (load(map.g + first) * set(2) - set(1)) * scale;
            const F z = load(map.b + first) * set(2) - set(1);
            const V3 right = look(t.right), up = look(t.up);
            const V3 across = right - n * dot(n, right);
            const V3 along = up - n * dot(n, up);
            const V3 v = n * z + normalized(across) * x + normalized(along) * y;
            const F square = dot(v, v);
            blend(choose(square > set(0), v * (set(1) / square_root(square)), n), own, nx, ny, nz);
          });
}

/// A block's surface, with what textures, lights and normal maps need.
struct BlockSurface {
  BlockMaterials materials;
  Surface surface;
  Coordinates at;
  bool textured = false, bent = false;

  /// Call it once materials are known.
  HWY_INLINE void begin(const VisibleBlock& block, bool own_base) {
    const bool whole = block.covered == ~std::uint64_t{0};
    if (!whole) std::memset(&surface, 0, sizeof surface);
    for (std::size_t m = 0; m < materials.count; ++m) {
      const BoundMaterial& own = *materials.material[m];
      bent |= own.normal != nullptr;
      textured |= (own.base_color != nullptr && !own_base) || own.metallic_roughness != nullptr ||
                  own.normal != nullptr || own.occlusion != nullptr || own.emissive != nullptr;
    }
    if (textured && !whole) std::memset(&at, 0, sizeof at);
    set_base(block, materials, surface);
  }
  /// Call it once coordinates are known.
  HWY_INLINE void bring_materials(const VisibleBlock& block, bool own_base, bool classic) {
    for (std::size_t m = 0; m < materials.count; ++m)
      set_material(block, materials, m, at, own_base, classic, surface);
  }
};

/// From the bin's set-up triangles.
HWY_INLINE void see_by_bin(const MaterialView& scene, const VisibleBlock& block, bool own_base,
                           BlockSurface& out) {
  const SeenBin& bin = *block.bin;
  const std::uint16_t* const places = bin.places_of(block.x0, block.y0);
  find_materials(scene, bin, places, block.covered, out.materials);
  out.begin(block, own_base);
  for (std::size_t first = 0; first < 64; first += kLanes) {
    const std::uint64_t covered = block.covered >> first & kAllLanes;
    if (covered == 0) continue;
    interpolate(scene, block, BinLookup{bin, places + first}, mask_of(covered), first, out.textured,
                out.at, out.surface);
  }
  out.bring_materials(block, own_base, scene.classic);
}

/// From the block alone.
HWY_INLINE void see_alone(const MaterialView& scene, const FrameGeometry& frame,
                          const VisibleBlock& block, bool own_base, BlockSurface& out) {
  const SeenMaterials of(scene, frame, block, out.materials);
  out.begin(block, own_base);
  for_each_vector(block, of,
                  [&](const MaterialLanes& t, const MaterialLookup& look, auto mine,
                      std::size_t first) HWY_ATTR {
                    interpolate(scene, block, LaneLookup{t, look}, mine, first, out.textured,
                                out.at, out.surface);
                  });
  out.bring_materials(block, own_base, scene.classic);
  if (out.bent) bend(block, of, out.materials, out.at, out.surface);
}

void shade(const MaterialView& scene, const FrameGeometry& frame, const VisibleBlock& block,
           bool linear, const float* own_base, BlockColors& colors) noexcept {
  if (block.covered == 0) return;
  BlockSurface seen;
  if (block.bin != nullptr)
    see_by_bin(scene, block, own_base != nullptr, seen);
  else
    see_alone(scene, frame, block, own_base != nullptr, seen);
  if (own_base != nullptr)
    for (int c = 0; c < 3; ++c)
      std::memcpy(seen.surface.channel[Surface::kBaseR + c], own_base + 64 * c, 64 * sizeof(float));
  if (scene.classic)
    light_classic_block(scene, seen.surface, block, colors);
  else if (scene.lights == nullptr)
    light_block<true>(scene, seen.surface, block, linear, colors);
  else
    light_block<false>(scene, seen.surface, block, linear, colors);
}

/// Loops take so many fragments at a time, so that compilers make whole vectors.
constexpr int kGroup = 8;

/// Fragments of one triangle in a block, packed; the last is repeated to a whole group.
struct alignas(64) Run {
  int n = 0, padded = 0;
  int lane[64];      ///< 8 · row + column
  double scale[64];  ///< as CornerShares
  float weight1[64], weight2[64];
  float x[64], y[64];  ///< px

  Run(std::uint64_t mask, const WeightPlanes& w, int x0, int y0, const ShadingPoints* points) {
    for (; mask != 0; mask &= mask - 1) lane[n++] = std::countr_zero(mask);
    for (padded = n; padded % kGroup != 0; ++padded) lane[padded] = lane[n - 1];
    for (int k = 0; k < padded; k += kGroup)
      for (int j = k; j < k + kGroup; ++j) {
        double dx = x0 + lane[j] % kBlockSize + 0.5 - w.x0;
        double dy = y0 + lane[j] / kBlockSize + 0.5 - w.y0;
        if (points != nullptr) {
          dx += static_cast<double>(points->dx[lane[j]]);
          dy += static_cast<double>(points->dy[lane[j]]);
        }
        x[j] = static_cast<float>(x0 + lane[j] % kBlockSize) + 0.5F;
        y[j] = static_cast<float>(y0 + lane[j] / kBlockSize) + 0.5F;
        if (points != nullptr) {
          x[j] += points->dx[lane[j]];
          y[j] += points->dy[lane[j]];
        }
        const CornerShares s = CornerShares::at(w, dx, dy);
        scale[j] = s.scale;
        weight1[j] = s.weight1;
        weight2[j] = s.weight2;
      }
  }
  [[nodiscard]] HWY_INLINE CornerShares shares(int j) const {
    return {scale[j], weight1[j], weight2[j]};
  }
};

/// a0 + w1 (a1 − a0) + w2 (a2 − a0): exact for a constant attribute.
HWY_INLINE void interpolate(const Run& run, float a0, float a1, float a2, float* HWY_RESTRICT out) {
  const float d1 = a1 - a0, d2 = a2 - a0;
  for (int k = 0; k < run.padded; k += kGroup)
    for (int j = k; j < k + kGroup; ++j) out[j] = a0 + run.shares(j).offset(d1, d2);
}

HWY_INLINE void interpolate_texcoords(const MaterialTriangle& t, const Run& run, Coordinates& out) {
  if (t.draw.mesh->texcoords.empty()) {
    std::memset(&out, 0, sizeof(out));
    return;
  }
  Vec2 corner[3];
  t.corners(t.draw.mesh->texcoords, corner);
  const Vec2 a = corner[0], d1 = corner[1] - a, d2 = corner[2] - a;
  const auto one = [&](float a0, float a1, float a2, float* HWY_RESTRICT value,
                       float* HWY_RESTRICT dx, float* HWY_RESTRICT dy) HWY_ATTR {
    const CoordinatePlane plane(t.planes, a0, a1, a2);
    for (int k = 0; k < run.padded; k += kGroup)
      for (int j = k; j < k + kGroup; ++j) {
        const Coordinate c = plane.at(run.shares(j));
        value[j] = c.value;
        dx[j] = c.dx;
        dy[j] = c.dy;
      }
  };
  one(a.x, d1.x, d2.x, out.u, out.u_dx, out.u_dy);
  one(a.y, d1.y, d2.y, out.v, out.v_dx, out.v_dy);
}

HWY_INLINE void fill(const Run& run, float value, float* out) {
  for (int k = 0; k < run.padded; ++k) out[k] = value;
}
/// A fragment's own alpha, for masks and blending.
HWY_INLINE void own_alpha(const MaterialTriangle& t, const BoundMaterial& material, const Run& run,
                          float* HWY_RESTRICT alpha) {
  const float base = material.base.w;
  if (t.draw.colors.empty()) {
    fill(run, base, alpha);
  } else {
    Vec4 c[3];
    t.corners(t.draw.colors, c);
    interpolate(run, c[0].w * base, c[1].w * base, c[2].w * base, alpha);
  }
  if (material.base_color == nullptr && material.alpha == nullptr) return;
  Coordinates at;
  interpolate_texcoords(t, run, at);
  if (material.base_color != nullptr)
    multiply_by<AlphaCodes, AlphaChannel>(*material.base_color, at, run.n, alpha);
  if (material.alpha != nullptr)
    multiply_by<RedCodes, RedChannel>(*material.alpha, at, run.n, alpha);
}

std::uint64_t alpha_test(const MaterialView& scene, const FrameGeometry& frame, std::uint64_t id,
                         std::uint64_t mask, int x0, int y0, const ShadingPoints* points) noexcept {
  const Draw& draw = frame.draw_of(id);
  const MaterialDraw& of = scene.draws[draw.number];
  const BoundMaterial& material = scene.material_of(of, draw.of_copy(id - draw.first_id).primitive);
  if (mask == 0 || material.alpha_mode != AlphaMode::mask) return mask;
  const MaterialTriangle t(scene, frame, draw, id);
  const Run run(mask, t.planes, x0, y0, points);
  alignas(64) float alpha[64];
  own_alpha(t, material, run, alpha);
  for (int k = 0; k < run.n; ++k)
    if (alpha[k] < material.alpha_cutoff) mask &= ~(std::uint64_t{1} << run.lane[k]);
  return mask;
}

AlphaMasks alpha(const MaterialView& scene, const FrameGeometry& frame, const VisibleBlock& block,
                 float frame_opacity, float* out) noexcept {
  AlphaMasks masks;
  const auto set = [&](int i, float a) {
    out[i] = a;
    masks.visible |= std::uint64_t{a > 0} << i;
    masks.opaque |= std::uint64_t{a == 1} << i;
  };
  std::memset(out, 0, 64 * sizeof(float));
  const Draw* draw = nullptr;
  for (std::uint64_t left = block.covered; left != 0;) {
    const std::uint64_t low = block.keys[std::countr_zero(left)] & kIdMask;
    const std::uint64_t mask = pixels_of(block.keys, low, left);
    left &= ~mask;
    const std::uint64_t id = id_of_key(low);
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) draw = &frame.draw_of(id);
    const MaterialDraw& of = scene.draws[draw->number];
    const BoundMaterial& material =
        scene.material_of(of, draw->of_copy(id - draw->first_id).primitive);
    const bool blends = material.alpha_mode == AlphaMode::blend;
    const float opacity = frame_opacity * material.opacity * of.opacity;
    if (!blends || has_constant_alpha(of, material)) {
      const float a = clamped_alpha(blends ? opacity * material.base.w : opacity);
      for (std::uint64_t m = mask; m != 0; m &= m - 1) set(std::countr_zero(m), a);
      continue;
    }
    const MaterialTriangle t(scene, frame, *draw, id);
    const Run run(mask, t.planes, block.x0, block.y0, block.points);
    alignas(64) float own[64];
    own_alpha(t, material, run, own);
    for (int k = 0; k < run.n; ++k) set(run.lane[k], clamped_alpha(opacity * own[k]));
  }
  return masks;
}

void premultiply(const float* alpha, BlockColors& colors) noexcept {
  const F32 d;
  for (float* const channel : {colors.r, colors.g, colors.b, colors.a})
    for (std::size_t i = 0; i < 64; i += kLanes) {
      const F a = load(alpha + i);
      hn::Store(hn::IfThenElseZero(a > set(0), load(channel + i) * a), d, channel + i);
    }
}

constexpr MaterialKernels kTable{shade, alpha_test, alpha, premultiply, see_bin};

}  // namespace
}  // namespace rastrum::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET

#if HWY_ONCE
#include <rastrum/parallel/by_isa.hpp>

namespace rastrum::raster {

const MaterialKernels& material_kernels(Isa isa) noexcept {
  static const MaterialKernels* const kTables[] =
      RASTRUM_BY_ISA(kTable, &scalar_material_kernels());
  return *kTables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
#endif
