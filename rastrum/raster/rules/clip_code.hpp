// SPDX-License-Identifier: BSD-3-Clause
// The clipper's code. The host compiles it in clip.cpp, a device in each translation unit. It stays
// a call there too, since few primitives need it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <rastrum/raster/rules/clip.hpp>

#if defined(__CUDACC__)
#define RASTRUM_CLIP RASTRUM_HD inline __attribute__((noinline))
#else
#define RASTRUM_CLIP
#endif

namespace rastrum::raster {

namespace clip_detail {

struct Corner {
  Vec4d clip;
  const ProjectedVertex* original;  ///< null: made by the clipper, or no float32 position
};

struct Polygon {
  int size = 0;
  Corner corners[kMaxPolygon];
};

/// Signed distance to a plane in homogeneous space; ≥ 0 is inside.
struct Plane {
  double x, y, z, w;
  [[nodiscard]] RASTRUM_HD double distance(const Corner& c) const {
    const double d = x * c.clip.x + y * c.clip.y + z * c.clip.z + w * c.clip.w;
    // float32 projection decides which vertices are inside.
    return c.original != nullptr ? std::max(d, 0.0) : d;
  }
};

RASTRUM_HD inline Corner at(const Corner& from, const Corner& to, double t) {
  const Vec4d &a = from.clip, &b = to.clip;
  return {
      {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t, a.w + (b.w - a.w) * t},
      nullptr};
}

RASTRUM_HD inline Corner between(const Corner& in, double d_in, const Corner& out, double d_out) {
  return at(in, out, d_in / (d_in - d_out));
}

RASTRUM_HD inline void cut(Polygon& polygon, const Plane& plane) {
  double d[kMaxPolygon];
  bool any_outside = false;
  for (int i = 0; i < polygon.size; ++i) {
    d[i] = plane.distance(polygon.corners[i]);
    any_outside |= d[i] < 0;
  }
  if (!any_outside) return;
  // Rounding may bend a huge polygon so that a plane crosses it more than twice. With too many
  // corners it is not worth drawing.
  Polygon kept;
  const auto keep = [&kept](const Corner& c) {
    if (kept.size < kMaxPolygon) kept.corners[kept.size] = c;
    ++kept.size;
  };
  for (int i = 0; i < polygon.size; ++i) {
    const int j = i + 1 == polygon.size ? 0 : i + 1;
    const Corner &a = polygon.corners[i], &b = polygon.corners[j];
    if (d[i] >= 0) keep(a);
    if (d[i] >= 0 && d[j] < 0) keep(between(a, d[i], b, d[j]));
    if (d[i] < 0 && d[j] >= 0) keep(between(b, d[j], a, d[i]));
  }
  if (kept.size > kMaxPolygon) kept.size = 0;
  polygon = kept;
}

/// Where w > 0, px · w = x · hw + w · hw and py · w = w · hh − y · hh. Opposite guard planes add up
/// to w · (max − min) ≥ 0, so they also remove what lies behind the eye of a caller's own
/// projection.
RASTRUM_HD inline std::array<Plane, 5> planes(Viewport viewport) {
  const double hw = viewport.half_width;
  const double hh = viewport.half_height;
  return {{{0, 0, -1, 1},
           {hw, 0, 0, hw - kGuardMinPx},
           {-hw, 0, 0, kGuardMaxPx - hw},
           {0, -hh, 0, hh - kGuardMinPx},
           {0, hh, 0, kGuardMaxPx - hh}}};
}

RASTRUM_HD inline std::int32_t snap_in_guard_band(double px) {
  const double clamped = std::clamp(px, double{kGuardMinPx}, double{kGuardMaxPx});
  return static_cast<std::int32_t>(std::nearbyint(clamped * kSubpixels));
}

RASTRUM_HD inline ProjectedVertex project_corner(const Corner& c, Viewport v) {
  if (c.original != nullptr) return *c.original;
  const double x = c.clip.x / c.clip.w * v.half_width + v.half_width;
  const double y = v.half_height - c.clip.y / c.clip.w * v.half_height;
  // Float32 depth may overflow far beyond a finite far plane; any depth ≤ 0 is drawn as 0.
  const double depth = std::clamp(c.clip.z / c.clip.w, -1e30, 1.0);
  return {snap_in_guard_band(x), snap_in_guard_band(y), static_cast<float>(depth), 0.0F};
}

}  // namespace clip_detail

RASTRUM_CLIP ClippedPolygon clip_triangle(const Vec4d (&clip)[3],
                                          const ProjectedVertex (&projected)[3],
                                          Viewport viewport) noexcept {
  clip_detail::Polygon polygon;
  polygon.size = 3;
  for (int i = 0; i < 3; ++i) {
    const bool has_position = projected[i].x_fx8 != kNeedsClip;
    polygon.corners[i] = {clip[i], has_position ? &projected[i] : nullptr};
  }
  for (const clip_detail::Plane& plane : clip_detail::planes(viewport))
    clip_detail::cut(polygon, plane);

  ClippedPolygon result;
  if (polygon.size < 3) return result;
  for (int i = 0; i < polygon.size; ++i) {
    if (!(polygon.corners[i].clip.w > 0)) return {};
    result.vertices[i] = clip_detail::project_corner(polygon.corners[i], viewport);
  }
  result.size = polygon.size;
  return result;
}

RASTRUM_CLIP bool clip_line(const Vec4d (&clip)[2], ProjectedVertex (&projected)[2],
                            Viewport viewport) noexcept {
  const auto corner = [&](int i) {
    return clip_detail::Corner{clip[i], projected[i].x_fx8 != kNeedsClip ? &projected[i] : nullptr};
  };
  const clip_detail::Corner a = corner(0), b = corner(1);
  // How much of the line is inside, measured from a and from b. A plane counts from its inside end.
  double from_a = 1, from_b = 1;
  for (const clip_detail::Plane& plane : clip_detail::planes(viewport)) {
    const double da = plane.distance(a), db = plane.distance(b);
    if (da < 0 && db < 0) return false;
    if (db < 0) from_a = std::min(from_a, da / (da - db));
    if (da < 0) from_b = std::min(from_b, db / (db - da));
  }
  if (from_a + from_b < 1) return false;
  const clip_detail::Corner ends[2] = {from_b < 1 ? clip_detail::at(b, a, from_b) : a,
                                       from_a < 1 ? clip_detail::at(a, b, from_a) : b};
  if (!(ends[0].clip.w > 0) || !(ends[1].clip.w > 0)) return false;
  const ProjectedVertex p0 = clip_detail::project_corner(ends[0], viewport);
  const ProjectedVertex p1 = clip_detail::project_corner(ends[1], viewport);
  projected[0] = p0;
  projected[1] = p1;
  return true;
}

RASTRUM_CLIP bool clip_point(const Vec4d& clip, Viewport viewport,
                             ProjectedVertex& projected) noexcept {
  const clip_detail::Corner corner{clip, nullptr};
  for (const clip_detail::Plane& plane : clip_detail::planes(viewport))
    if (plane.distance(corner) < 0) return false;
  if (!(clip.w > 0)) return false;
  projected = clip_detail::project_corner(corner, viewport);
  return true;
}

RASTRUM_CLIP double orientation(const Vec4d (&c)[3]) noexcept {
  // The volume of the triangle with the eye. Scaling keeps products of coordinates near FLT_MAX /
  // 16 far from overflow.
  double m[3][3];
  for (int i = 0; i < 3; ++i) {
    const double scale = std::max({std::abs(c[i].x), std::abs(c[i].y), std::abs(c[i].w), 1e-300});
    m[i][0] = c[i].x / scale;
    m[i][1] = c[i].y / scale;
    m[i][2] = c[i].w / scale;
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

}  // namespace rastrum::raster
