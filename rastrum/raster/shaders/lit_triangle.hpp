// What the lit shaders know of a triangle: set up once in float32, kept while a bin is shaded.
//
// float32 weights lose about |longest edge|² / |twice the area| ulps to cancellation, so thin and
// clipped triangles are interpolated in float64 (interpolate.hpp) instead.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/raster/interpolate.hpp>
#include <rastrum/raster/shaders/lit.hpp>

namespace rastrum::raster {

/// A triangle as the rows need it.
struct LitTriangle {
  std::uint64_t low;  ///< of the word; 0: none yet
  bool exact;         ///< interpolate with `planes`
  float x0, y0;       ///< λ₁ = p1 (x − x0) + q1 (y − y0), λ₂ alike
  float p1, q1, p2, q2;
  float inv_w[3];
  Vec3 normal[3];  ///< world space
  Vec3 color[3];
  WeightPlanes planes;
};

/// Sets up the triangle whose words end in `low`.
void fetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                    bool wants_normals, LitTriangle& out);

/// Asks the cache for what fetch_triangle reads at random.
void prefetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t id,
                       bool wants_normals) noexcept;

/// The triangles of a bin that were seen last, by their ids' low bits: rows and blocks beside
/// mostly meet the same ones again.
struct KeptTriangles {
  static constexpr std::size_t kCount = 256;
  LitTriangle triangles[kCount];

  const LitTriangle& find(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                          bool wants_normals) {
    LitTriangle& t = triangles[low % kCount];
    if (t.low != low) fetch_triangle(scene, frame, low, wants_normals, t);
    return t;
  }
};
static_assert(sizeof(KeptTriangles) <= kMaxShaderScratch);

}  // namespace rastrum::raster
