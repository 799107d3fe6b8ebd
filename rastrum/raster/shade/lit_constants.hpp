// The numbers of the lit shaders, once for the scalar and the SIMD form.
#pragma once

#include <cstdint>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

struct FragmentRuns;

inline constexpr Vec3 kDefaultBase{0.8F, 0.7F, 0.6F};
inline constexpr Vec3 kWireColor{0.1F, 0.1F, 0.12F};
inline constexpr float kAmbient = 0.1F, kDiffuse = 0.8F, kSpecular = 0.3F;
/// (0.4, 0.6, 1) / √1.52.
inline constexpr Vec3 kLight{0.32444284F, 0.48666426F, 0.81110710F};

/// A hash of the id (the finalizer of MurmurHash3) as an 8-bit colour, never black.
RASTRUM_HD constexpr Vec3 id_color(std::uint64_t id) {
  auto h = static_cast<std::uint32_t>(id ^ (id >> 32));
  h ^= h >> 16;
  h *= 0x85ebca6bU;
  h ^= h >> 13;
  h *= 0xc2b2ae35U;
  h ^= h >> 16;
  const auto channel = [&](int shift) {
    return static_cast<float>((h >> shift & 255U) | 32U) * (1.0F / 255.0F);
  };
  return {channel(0), channel(8), channel(16)};
}

/// The surface of a block as lighting needs it, by sample.
struct alignas(64) LitBlock {
  float n[3][64];             ///< the normal, world space, of any length
  float base[3][64];          ///< the base colour
  std::uint64_t normals = 0;  ///< samples whose `n` is set
};

/// Normals of a block as images show them: of unit length, turned to the viewer, 0 where there is
/// none. Element 8 · row + column.
struct SeenNormals {
  Vec3 world[64], camera[64];
};

/// Colours of fragments that lie side by side by triangle, times `alpha`, which is above 0
/// (shade_runs of shader.hpp). Returns false where there are no lanes for `lit.model`.
bool shade_lit_runs(Isa isa, const LitShading& lit, const FrameGeometry& frame,
                    const FragmentRuns& runs, float alpha, Vec4* colors) noexcept;

/// The SIMD form (lit_simd.cpp); its colours are opaque. Returns false where it has none for
/// `model`.
bool shade_lit_simd(Isa isa, Shader model, const LitScene& scene, const FrameGeometry& frame,
                    const VisibleBlock& block, BlockColors& colors) noexcept;
/// The same to 8 bits (store_shaded).
bool store_lit_simd(Isa isa, Shader model, const LitScene& scene, const FrameGeometry& frame,
                    const VisibleBlock& block, Rgba8 empty, BlockPixels to) noexcept;
/// The same as shade_lit_simd, with the base colours that `surface` holds. Its normals are not
/// read.
bool shade_own_base_simd(Isa isa, Shader model, const LitScene& scene, const FrameGeometry& frame,
                         const VisibleBlock& block, LitBlock& surface,
                         BlockColors& colors) noexcept;
/// The normals of the covered samples, which are of meshes: those of `surface` where it has all,
/// else they are interpolated into it. `cut`: triangles may not cover their pixels' centres.
/// `to_camera`: null where `out.camera` is not asked for. False: there are no lanes.
bool seen_normals_simd(Isa isa, const LitScene& scene, const FrameGeometry& frame,
                       const VisibleBlock& block, LitBlock& surface, bool cut,
                       const float (*to_camera)[3], SeenNormals& out) noexcept;
/// Lights a surface that others have found; alpha is not set.
bool light_lit_simd(Isa isa, Shader model, const ViewRays& rays, const LightSet* lights,
                    const VisibleBlock& block, const LitBlock& surface,
                    BlockColors& colors) noexcept;

}  // namespace rastrum::raster
