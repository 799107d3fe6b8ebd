// SPDX-License-Identifier: BSD-3-Clause
// A triangle for the lit shaders, set up once in float32 and kept while a bin is shaded.
//
// float32 weights lose about |longest edge|² / |twice the area| ulps to cancellation, so thin and
// clipped triangles are interpolated in float64 (interpolate.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/normals.hpp>

namespace rastrum::raster {

struct LitTriangle {
  std::uint64_t low;  ///< of the key; 0: none
  bool exact;         ///< interpolate with `planes`
  float x0, y0;       ///< λ₁ = p1 (x − x0) + q1 (y − y0), λ₂ alike
  float p1, q1, p2, q2;
  float inv_w[3];
  Vec3 normal[3];  ///< world space
  Vec3 color[3];
  WeightPlanes planes;
};

RASTRUM_HD inline Vec3 LitView::base_color(const LitDraw& draw, std::size_t face) const {
  constexpr Vec3 default_base = kDefaultBase;  // a device has no address of a namespace's constant
  if (materials.empty()) return draw.colors.empty() ? default_base : Vec3{1, 1, 1};
  return materials[draw.face_materials.empty() ? draw.material : draw.face_materials[face]];
}

namespace lit_detail {

/// Up to this ratio of squared longest edge to twice the area float32 weights are good to 1e-5.
inline constexpr float kThin = 32.0F;
/// Below this ratio of corners' 1 / w a far corner's weight is lost in the near one's rounding.
inline constexpr float kSteep = 1e-4F;

template <class Geometry>
RASTRUM_HD void fetch_weights(const Geometry& frame, const Draw& draw,
                              const std::uint32_t (&vertex)[3], LitTriangle& out) {
  const ProjectedVertex v0 = frame.vertex(draw, vertex[0]), v1 = frame.vertex(draw, vertex[1]),
                        v2 = frame.vertex(draw, vertex[2]);
  out.exact = true;
  if (v0.x_fx8 == kNeedsClip || v1.x_fx8 == kNeedsClip || v2.x_fx8 == kNeedsClip) {
    out.planes = weight_planes(frame, draw, vertex);
    return;
  }
  constexpr float kPx = 1.0F / kSubpixels;
  const float e1x = static_cast<float>(v1.x_fx8 - v0.x_fx8) * kPx;
  const float e1y = static_cast<float>(v1.y_fx8 - v0.y_fx8) * kPx;
  const float e2x = static_cast<float>(v2.x_fx8 - v0.x_fx8) * kPx;
  const float e2y = static_cast<float>(v2.y_fx8 - v0.y_fx8) * kPx;
  const float det = e1x * e2y - e2x * e1y;
  const float extent = (e1x * e1x + e1y * e1y) + (e2x * e2x + e2y * e2y);
  const float smallest = std::min({v0.inv_w, v1.inv_w, v2.inv_w});
  const float largest = std::max({v0.inv_w, v1.inv_w, v2.inv_w});
  // Up to 16 px every product of edges is exact, even in a thin triangle.
  const bool thin = extent > 128.0F && !(extent < kThin * std::abs(det));
  out.exact = thin || !(smallest > kSteep * largest);
  if (out.exact) {
    out.planes = weight_planes(frame, draw, vertex);
    return;
  }
  const float inv_det = 1.0F / det;
  out.x0 = static_cast<float>(v0.x_fx8) * kPx;
  out.y0 = static_cast<float>(v0.y_fx8) * kPx;
  out.p1 = e2y * inv_det;
  out.q1 = -e2x * inv_det;
  out.p2 = -e1y * inv_det;
  out.q2 = e1x * inv_det;
  // Only ratios matter. Far away 1 / w is so small that squares of normals would underflow.
  out.inv_w[0] = v0.inv_w / largest;
  out.inv_w[1] = v1.inv_w / largest;
  out.inv_w[2] = v2.inv_w / largest;
}

}  // namespace lit_detail

/// Display values at a triangle's corners, for a draw that has colours.
RASTRUM_HD inline void display_colors(const LitDraw& lit, const TrianglePlace& place,
                                      const std::uint32_t (&vertex)[3], Vec4 (&out)[3]) {
  lit.colors.corners(place, vertex, out);
  if (lit.color_space == ColorSpace::linear)
    for (Vec4& c : out) c = display_value(c);
}

/// Sets the normals and colours of triangle `t` that are wanted.
RASTRUM_HD inline void fetch_attributes(const LitView& scene, const LitDraw& lit, std::uint64_t t,
                                        const std::uint32_t (&vertex)[3], bool wants_normals,
                                        LitTriangle& out) {
  const TrianglePlace place = lit.mesh->place(t);
  if (wants_normals) {
    corner_normals(*lit.mesh, place, vertex, out.normal);
    if (!lit.identity)
      for (Vec3& n : out.normal) n = lit.to_world(n);
  }
  if (!scene.colored) return;
  const Vec3 base = scene.base_color(lit, place.face);
  if (lit.colors.empty()) {
    for (Vec3& c : out.color) c = base;
    return;
  }
  Vec4 color[3];
  display_colors(lit, place, vertex, color);
  for (int c = 0; c < 3; ++c)
    out.color[c] = {base.x * color[c].x, base.y * color[c].y, base.z * color[c].z};
}

/// Sets up the triangle of `draw` whose keys end in `low`.
template <class Geometry>
RASTRUM_HD void fetch_triangle(const LitView& scene, const LitDraw& lit, const Geometry& frame,
                               const Draw& draw, std::uint64_t low, bool wants_normals,
                               LitTriangle& out) {
  out.low = low;
  const std::uint64_t t = kIdMask - low - draw.first_id;
  std::uint32_t vertex[3];
  draw.vertices(t, vertex);
  lit_detail::fetch_weights(frame, draw, vertex, out);
  if (!wants_normals && !scene.colored) return;
#if !defined(__CUDA_ARCH__)
  if (draw.is_copied()) {
    const Draw::OfCopy of = draw.of_copy(t);
    for (std::uint32_t& v : vertex) v -= draw.first_vertex_of(of.copy);
    return fetch_attributes(scene, lit.of(lit.copies[of.copy]), of.primitive, vertex, wants_normals,
                            out);
  }
#endif
  fetch_attributes(scene, lit, t, vertex, wants_normals, out);
}

template <class Geometry>
RASTRUM_HD void fetch_triangle(const LitView& scene, const Geometry& frame, std::uint64_t low,
                               bool wants_normals, LitTriangle& out) {
  const Draw& draw = frame.draw_of(kIdMask - low);
  fetch_triangle(scene, scene.draws[draw.number], frame, draw, low, wants_normals, out);
}

void fetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                    bool wants_normals, LitTriangle& out);

/// Prefetches what fetch_triangle reads at random.
void prefetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t id,
                       bool wants_normals) noexcept;

/// The last triangles of a bin, by their ids' low bits: neighbouring pixels and blocks mostly see
/// the same ones. All 0: none.
struct KeptTriangles {
  static constexpr std::size_t kCount = 256;
  LitTriangle triangles[kCount];
  alignas(64) std::byte lanes[9216];  ///< of the last block (lit_seen-inl.hpp)

  void clear() {
    for (LitTriangle& t : triangles) t.low = 0;
    std::fill_n(lanes, sizeof lanes, std::byte{0});
  }

  const LitTriangle& find(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                          bool wants_normals) {
    LitTriangle& t = triangles[low % kCount];
    if (t.low != low) fetch_triangle(scene, frame, low, wants_normals, t);
    return t;
  }
};

}  // namespace rastrum::raster
