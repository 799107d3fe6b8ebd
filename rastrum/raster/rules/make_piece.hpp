// SPDX-License-Identifier: BSD-3-Clause
// Triangle setup: three snapped vertices to a piece. This scalar form is the reference;
// setup_simd.cpp does the same float64 operations on several triangles at once.
#pragma once

#include <bit>
#include <cstdint>

#include <rastrum/config.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/quadric.hpp>

namespace rastrum::raster {

enum class SetupResult : std::uint8_t { drawn, culled };

/// In (1/256 px)². Negative for a counter-clockwise (front-facing) triangle, because y points down.
/// Differences need 25 bits and a sign, so the result is below 2^51.
RASTRUM_HD inline std::int64_t twice_area(const ProjectedVertex& a, const ProjectedVertex& b,
                                          const ProjectedVertex& c) {
  const std::int64_t dx1 = b.x_fx8 - a.x_fx8;
  const std::int64_t dy1 = b.y_fx8 - a.y_fx8;
  const std::int64_t dx2 = c.x_fx8 - a.x_fx8;
  const std::int64_t dy2 = c.y_fx8 - a.y_fx8;
  return dx1 * dy2 - dx2 * dy1;
}

RASTRUM_HD inline bool is_culled(std::int64_t area, Cull cull) {
  return area == 0 || (cull == Cull::back && area > 0) || (cull == Cull::front && area < 0);
}

/// `area` is not 0.
RASTRUM_HD inline void set_corners(const ProjectedVertex& a, const ProjectedVertex& b,
                                   const ProjectedVertex& c, std::int64_t area, Piece& piece) {
  const ProjectedVertex& second = area > 0 ? b : c;
  const ProjectedVertex& third = area > 0 ? c : b;
  piece.x[0] = a.x_fx8;
  piece.y[0] = a.y_fx8;
  piece.x[1] = second.x_fx8;
  piece.y[1] = second.y_fx8;
  piece.x[2] = third.x_fx8;
  piece.y[2] = third.y_fx8;
}

/// Every product and difference of positions is exact in float64, so swapping b and c only changes
/// the signs of numerator and denominator.
RASTRUM_HD inline void set_depth_plane(const ProjectedVertex& a, const ProjectedVertex& b,
                                       const ProjectedVertex& c, std::int64_t area, Piece& piece) {
  const double dx1 = b.x_fx8 - a.x_fx8;
  const double dy1 = b.y_fx8 - a.y_fx8;
  const double dx2 = c.x_fx8 - a.x_fx8;
  const double dy2 = c.y_fx8 - a.y_fx8;
  const double dz1 = static_cast<double>(b.depth) - static_cast<double>(a.depth);
  const double dz2 = static_cast<double>(c.depth) - static_cast<double>(a.depth);
  const double det = static_cast<double>(area);
  piece.z0 = a.depth;
  piece.zx = static_cast<float>((dz1 * dy2 - dz2 * dy1) / det * kSubpixels);
  piece.zy = static_cast<float>((dz2 * dx1 - dz1 * dx2) / det * kSubpixels);
}

/// Fills `piece` unless the triangle is culled: no area, facing away, or no sample of `view` in its
/// box. Vertices must be in the guard band. `reach`: as in sample_bounds.
RASTRUM_HD inline SetupResult make_piece(const ProjectedVertex& a, const ProjectedVertex& b,
                                         const ProjectedVertex& c, std::uint64_t id,
                                         std::uint32_t flags, Cull cull, Rect view, Piece& piece,
                                         int reach = 0) {
  const std::int64_t area = twice_area(a, b, c);
  if (is_culled(area, cull)) return SetupResult::culled;
  set_corners(a, b, c, area, piece);
  if (sample_bounds(piece.x, piece.y, view, reach).empty()) return SetupResult::culled;
  set_depth_plane(a, b, c, area, piece);
  piece.flags = flags | (area > 0 ? kFacesAway : 0);
  piece.low = kIdMask - id;
  return SetupResult::drawn;
}

/// Adds a constant and `slope` times the steepest change per px along an axis (GL's factor), both
/// in units of reversed depth.
RASTRUM_HD inline void add_depth_bias(Piece& p, float constant, float slope) {
  if (constant == 0 && slope == 0) return;
  const double zx = p.zx < 0 ? -p.zx : p.zx;
  const double zy = p.zy < 0 ? -p.zy : p.zy;
  const double steepest = zx > zy ? zx : zy;
  const double z0 = static_cast<double>(p.z0) + static_cast<double>(constant) +
                    static_cast<double>(slope) * steepest;
  // Finite, so that depth stays monotone.
  p.z0 = static_cast<float>(z0 > -1e30 ? (z0 < 1e30 ? z0 : 1e30) : -1e30);
}

/// Depth at pixel (x, y), in [+0, 1], of a piece that is no quadric. Setup can use it without a
/// call.
RASTRUM_HD inline float plane_depth_at(const Piece& p, int x, int y) {
  constexpr float kPxPerSubpixel = 1.0F / kSubpixels;
  const float x0 = static_cast<float>(p.x[0]) * kPxPerSubpixel;
  const float y0 = static_cast<float>(p.y[0]) * kPxPerSubpixel;
  const float dx = (static_cast<float>(x) + 0.5F) - x0;
  const float dy = (static_cast<float>(y) + 0.5F) - y0;
  const float d = p.z0 + p.zx * dx + p.zy * dy;
  // Turns −0 and NaN into +0.
  const float at_least_0 = d > 0 ? d : 0.0F;
  return at_least_0 < 1 ? at_least_0 : 1.0F;
}
/// The same for any piece.
RASTRUM_HD inline float depth_at(const Piece& p, int x, int y) {
  return is_quadric(p) ? sample_quadric(p, x, y).depth : plane_depth_at(p, x, y);
}

/// The largest depth at any sample of the rectangle, at the corner that the slopes choose. Rounding
/// keeps order, so every operation is monotone in x and in y, and no other sample is nearer.
/// Requires finite slopes.
RASTRUM_HD inline float highest_depth(const Piece& p, Rect r) {
  if (is_quadric(p)) return quadric_of(p).highest;
  return plane_depth_at(p, p.zx > 0 ? r.x1 - 1 : r.x0, p.zy > 0 ? r.y1 - 1 : r.y0);
}
RASTRUM_HD inline float lowest_depth(const Piece& p, Rect r) {
  if (is_quadric(p)) return quadric_of(p).lowest;
  return plane_depth_at(p, p.zx > 0 ? r.x0 : r.x1 - 1, p.zy > 0 ? r.y0 : r.y1 - 1);
}
/// Slopes that overflow make NaNs at samples level with vertex 0, so no bound holds.
RASTRUM_HD inline bool has_depth_bounds(const Piece& p) {
  return is_quadric(p) || (p.zx - p.zx == 0 && p.zy - p.zy == 0);
}

RASTRUM_HD inline std::uint64_t make_key(float depth, std::uint64_t low) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(depth)} << kIdBits | low;
}

}  // namespace rastrum::raster
