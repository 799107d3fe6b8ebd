// Materials in lanes, compiled once per instruction set: plain loops where compilers vectorize
// them, Highway where they do not (the lights). A block is done in two steps: each triangle's run
// of fragments fills its part of a surface (interpolation and textures), then the whole block is
// lit at once.
#include <rastrum/parallel/simd_targets.hpp>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rastrum/raster/shade/material_simd.cpp"
#include <hwy/foreach_target.h>  // must precede highway.h
#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <cstring>

#include <rastrum/raster/shade/interpolate.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/material_constants.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>
#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/shade/srgb.hpp>
#include <rastrum/raster/shade/texture_lanes-inl.hpp>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_BEFORE_NAMESPACE();
namespace rastrum::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Fragments of one triangle in a block, densely; the last is repeated up to a whole group.
struct alignas(64) Run {
  int n = 0, padded = 0;
  int lane[64];      ///< 8 · row + column
  double scale[64];  ///< as CornerShares
  float weight1[64], weight2[64];
  float x[64], y[64];  ///< where they are, px

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

/// a0 + w1 (a1 − a0) + w2 (a2 − a0): exact for an attribute that is constant.
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

/// What the lights need to know of 64 fragments.
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
    kChannels
  };
  float channel[kChannels][64];
};

HWY_INLINE void fill(const Run& run, float value, float* out) {
  for (int k = 0; k < run.padded; ++k) out[k] = value;
}
HWY_INLINE void multiply(const Run& run, const float* HWY_RESTRICT factor,
                         float* HWY_RESTRICT out) {
  for (int k = 0; k < run.padded; k += kGroup)
    for (int j = k; j < k + kGroup; ++j) out[j] *= factor[j];
}

/// Interpolated (or flat) normals, bent by the normal map, turned to the side that is seen.
HWY_INLINE void fill_normals(const MaterialView& scene, const MaterialTriangle& t,
                             const BoundMaterial& material, const Run& run, const Coordinates& at,
                             Surface& out) {
  const MeshView& mesh = *t.draw.mesh;
  float* HWY_RESTRICT nx = out.channel[Surface::kNormalX];
  float* HWY_RESTRICT ny = out.channel[Surface::kNormalY];
  float* HWY_RESTRICT nz = out.channel[Surface::kNormalZ];
  const Vec3 face = t.face_normal();
  const ViewRays rays = scene.rays;
  alignas(64) float side[64];
  for (int k = 0; k < run.padded; k += kGroup)
    for (int j = k; j < k + kGroup; ++j)
      side[j] = is_seen_from_behind(rays, face, run.x[j], run.y[j]) ? -1.0F : 1.0F;
  if (mesh.normals.empty()) {
    for (int k = 0; k < run.padded; k += kGroup)
      for (int j = k; j < k + kGroup; ++j) {
        nx[j] = face.x * side[j];
        ny[j] = face.y * side[j];
        nz[j] = face.z * side[j];
      }
  } else {
    Vec3 n[3];
    t.corners(mesh.normals, n);
    for (Vec3& c : n) c = times(t.draw.normal_matrix, c);
    interpolate(run, n[0].x, n[1].x, n[2].x, nx);
    interpolate(run, n[0].y, n[1].y, n[2].y, ny);
    interpolate(run, n[0].z, n[1].z, n[2].z, nz);
    for (int k = 0; k < run.padded; k += kGroup)
      for (int j = k; j < k + kGroup; ++j) {
        const Vec3 smooth = turned({nx[j], ny[j], nz[j]}, face, side[j]);
        nx[j] = smooth.x;
        ny[j] = smooth.y;
        nz[j] = smooth.z;
      }
  }
  if (material.normal == nullptr) return;

  const TangentFrame frame(t);
  Texels map;
  sample(*material.normal, at, run.n, run.padded, map);
  for (int k = 0; k < run.padded; k += kGroup)
    for (int j = k; j < k + kGroup; ++j) {
      // What is a bump on the front is a dent on the back: the tangents turn with the normal.
      const Vec3 bent = frame.bend({nx[j], ny[j], nz[j]}, map.r[j], map.g[j], map.b[j],
                                   material.normal_scale * side[j]);
      nx[j] = bent.x;
      ny[j] = bent.y;
      nz[j] = bent.z;
    }
}

/// One triangle's part of the surface, densely.
HWY_INLINE void fill_surface(const MaterialView& scene, const MaterialTriangle& t, const Run& run,
                             Surface& out) {
  const BoundMaterial& m = scene.material_of(t.draw, t.index);
  float* const r = out.channel[Surface::kBaseR];
  float* const g = out.channel[Surface::kBaseG];
  float* const b = out.channel[Surface::kBaseB];
  float* const metallic = out.channel[Surface::kMetallic];
  float* const roughness = out.channel[Surface::kRoughness];
  float* const occlusion = out.channel[Surface::kOcclusion];
  float* const emissive_r = out.channel[Surface::kEmissiveR];
  float* const emissive_g = out.channel[Surface::kEmissiveG];
  float* const emissive_b = out.channel[Surface::kEmissiveB];

  Coordinates at;
  const bool textured = m.base_color != nullptr || m.metallic_roughness != nullptr ||
                        m.normal != nullptr || m.occlusion != nullptr || m.emissive != nullptr;
  if (textured) interpolate_texcoords(t, run, at);
  Texels texels;
  const auto look_up = [&](const MipChain& chain)
                           HWY_ATTR { sample(chain, at, run.n, run.padded, texels); };

  if (t.draw.colors.empty()) {
    fill(run, m.base.x, r);
    fill(run, m.base.y, g);
    fill(run, m.base.z, b);
  } else {
    Vec4 c[3];
    t.corners(t.draw.colors, c);
    for (Vec4& color : c) color = color * m.base;
    interpolate(run, c[0].x, c[1].x, c[2].x, r);
    interpolate(run, c[0].y, c[1].y, c[2].y, g);
    interpolate(run, c[0].z, c[1].z, c[2].z, b);
  }
  if (m.base_color != nullptr) {
    look_up(*m.base_color);
    multiply(run, texels.r, r);
    multiply(run, texels.g, g);
    multiply(run, texels.b, b);
  }
  fill(run, m.unlit ? 1.0F : 0.0F, out.channel[Surface::kUnlit]);

  fill(run, m.metallic, metallic);
  fill(run, m.roughness, roughness);
  if (m.metallic_roughness != nullptr) {
    look_up(*m.metallic_roughness);
    multiply(run, texels.g, roughness);
    multiply(run, texels.b, metallic);
  }
  fill(run, 1, occlusion);
  if (m.occlusion != nullptr) {
    look_up(*m.occlusion);
    for (int k = 0; k < run.padded; ++k)
      occlusion[k] = 1 + m.occlusion_strength * (texels.r[k] - 1);
  }
  fill(run, m.emission.x, emissive_r);
  fill(run, m.emission.y, emissive_g);
  fill(run, m.emission.z, emissive_b);
  if (m.emissive != nullptr) {
    look_up(*m.emissive);
    multiply(run, texels.r, emissive_r);
    multiply(run, texels.g, emissive_g);
    multiply(run, texels.b, emissive_b);
  }
  fill_normals(scene, t, m, run, at, out);
}

using Floats = hn::ScalableTag<float>;
using F = hn::Vec<Floats>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Floats{}));

#include <rastrum/raster/kernels/lane_math-inl.hpp>

#include <rastrum/raster/kernels/lookups-inl.hpp>
#include <rastrum/raster/shade/lights-inl.hpp>
#include <rastrum/raster/shade/srgb_curve-inl.hpp>

#include <rastrum/raster/shade/material_light-inl.hpp>  // after the curve and the lights
#undef RASTRUM_LANES

HWY_INLINE F load(const float* p) {
  return hn::Load(Floats{}, p);
}
HWY_INLINE V3 load(const float* x, const float* y, const float* z) {
  return {load(x), load(y), load(z)};
}
HWY_INLINE void store(V3 a, float* x, float* y, float* z) {
  hn::Store(a.x, Floats{}, x);
  hn::Store(a.y, Floats{}, y);
  hn::Store(a.z, Floats{}, z);
}
/// Lights 64 fragments; what lies outside the covered ones does not matter.
template <bool kFixed>
HWY_NOINLINE void light_block(const MaterialView& scene, const Surface& s,
                              const VisibleBlock& block, bool linear, BlockColors& out) {
  const ViewRays& rays = scene.rays;
  const ShadingPoints* const points = block.points;
  const auto& c = s.channel;
  for (int i = 0; i < 64; i += kLanes) {
    F px = load(kSample.x + i) + set(static_cast<float>(block.x0));
    F py = load(kSample.y + i) + set(static_cast<float>(block.y0));
    if (points != nullptr) {
      px = px + load(points->dx + i);
      py = py + load(points->dy + i);
    }
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
      color = light(rays, lit, px, py);
    } else {
      alignas(64) float depth[kLanes];
      for (int k = 0; k < kLanes; ++k) depth[k] = depth_of_key(block.keys[i + k]);
      color = light_by(*scene.lights, rays, lit, px, py, load(depth));
    }
    store(written(choose(unlit, base, color), linear), out.r + i, out.g + i, out.b + i);
  }
}

/// The samples of `left` that see the triangle of `low`.
HWY_INLINE std::uint64_t samples_of(std::uint64_t low, const std::uint64_t* keys,
                                    std::uint64_t left) {
  std::uint64_t mask = 0;
  for (std::uint64_t m = left; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    mask |= std::uint64_t{(keys[i] & kIdMask) == low} << i;
  }
  return mask;
}

void shade(const MaterialView& scene, const FrameGeometry& frame, const VisibleBlock& block,
           bool linear, const float* own_base, BlockColors& colors) noexcept {
  const std::uint64_t* const keys = block.keys;
  const int x0 = block.x0, y0 = block.y0;
  std::uint64_t left = block.covered;
  Surface surface;
  if (left != ~std::uint64_t{0}) std::memset(&surface, 0, sizeof(surface));
  const Draw* draw = nullptr;
  while (left != 0) {
    const std::uint64_t low = keys[std::countr_zero(left)] & kIdMask;
    const std::uint64_t mask = samples_of(low, keys, left);
    left &= ~mask;
    const std::uint64_t id = id_of_key(low);
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) draw = &frame.draw_of(id);
    const MaterialTriangle triangle(scene, frame, *draw, id);
    const Run run(mask, triangle.planes, x0, y0, block.points);
    if (run.n == 64) {
      fill_surface(scene, triangle, run, surface);
      break;
    }
    Surface part;
    fill_surface(scene, triangle, run, part);
    for (int c = 0; c < Surface::kChannels; ++c)
      for (int k = 0; k < run.n; ++k) surface.channel[c][run.lane[k]] = part.channel[c][k];
  }
  if (own_base != nullptr)
    for (int c = 0; c < 3; ++c)
      std::memcpy(surface.channel[Surface::kBaseR + c], own_base + 64 * c, 64 * sizeof(float));
  if (scene.lights == nullptr)
    light_block<true>(scene, surface, block, linear, colors);
  else
    light_block<false>(scene, surface, block, linear, colors);
}

/// A fragment's own alpha: what a mask tests and what blends.
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
  const auto multiply_alpha = [&](int k, float value) HWY_ATTR { alpha[k] *= value; };
  if (material.base_color != nullptr)
    sample<AlphaChannel>(*material.base_color, at, run.n, run.padded, multiply_alpha);
  if (material.alpha != nullptr)
    sample<RedChannel>(*material.alpha, at, run.n, run.padded, multiply_alpha);
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
    const std::uint64_t mask = samples_of(low, block.keys, left);
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
  const Floats d;
  for (float* const channel : {colors.r, colors.g, colors.b, colors.a})
    for (int i = 0; i < 64; i += kLanes) {
      const F a = load(alpha + i);
      hn::Store(hn::IfThenElseZero(a > set(0), load(channel + i) * a), d, channel + i);
    }
}

constexpr MaterialKernels kTable{shade, alpha_test, alpha, premultiply};

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::raster
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
