// SPDX-License-Identifier: BSD-3-Clause
// A draw's primitive to its pieces by the complete, slow path with the clipper. The reference
// rasterizer uses it for all, fast ones for what the setup kernel leaves: triangles with clipping
// or a depth bias, lines and points. A device uses it for all (cuda/pieces.cuh), so it is a
// template on the geometry: FrameGeometry or DeviceGeometry.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/make_quadric.hpp>
#include <rastrum/raster/rules/points_and_lines.hpp>

namespace rastrum::raster {

/// The most pieces of a primitive: a polygon's fan.
inline constexpr int kMaxPieces = kMaxPolygon - 2;

enum class Fate : std::uint8_t { drawn, clipped, culled, dropped };

template <std::size_t n>
struct PrimitiveCorners {
  ProjectedVertex projected[n];
  bool needs_clip = false;
  Vec4d clip[n];  ///< if one of them needs clipping
  bool finite = true;

  template <class Geometry>
  RASTRUM_HD PrimitiveCorners(const Geometry& frame, const Draw& draw, std::uint64_t primitive) {
    for (std::size_t i = 0; i < n; ++i) {
      projected[i] = frame.vertex(draw, draw.vertex(primitive, static_cast<int>(i)));
      needs_clip |= projected[i].x_fx8 == kNeedsClip;
    }
    for (std::size_t i = 0; i < n && needs_clip; ++i) {
      const Vec4d c = frame.clip_position(draw, draw.vertex(primitive, static_cast<int>(i)));
      clip[i] = c;
      finite &=
          std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) && std::isfinite(c.w);
    }
  }
};

template <class Geometry, class Emit>
RASTRUM_HD Fate assemble_triangle(const Geometry& frame, const Draw& draw, std::uint64_t id,
                                  std::uint32_t flags, const PrimitiveCorners<3>& c,
                                  SampleOffset at, int reach, Emit&& emit) {
  if (!c.finite) return Fate::dropped;
  const Rect view{0, 0, frame.width, frame.height};
  const Cull cull = draw.effective_cull();
  Piece piece;
  const auto make = [&](const ProjectedVertex& v0, const ProjectedVertex& v1,
                        const ProjectedVertex& v2, std::uint32_t with, Cull side) {
    return make_piece(moved(v0, at), moved(v1, at), moved(v2, at), id, with, side, view, piece,
                      reach);
  };
  if (!c.needs_clip) {
    const auto& v = c.projected;
    if (make(v[0], v[1], v[2], flags, cull) == SetupResult::culled) return Fate::culled;
    emit(piece);
    return Fate::drawn;
  }
  const double facing = orientation(c.clip);
  if (facing == 0 || (cull == Cull::back && facing < 0) || (cull == Cull::front && facing > 0))
    return Fate::culled;
  const ClippedPolygon polygon = clip_triangle(c.clip, c.projected, frame.viewport);
  // Snapping may turn a sliver of the polygon over. Only pieces that face as the triangle does
  // count.
  const Cull other_side = facing > 0 ? Cull::back : Cull::front;
  bool any = false;
  for (int i = 2; i < polygon.size; ++i)
    if (make(polygon.vertices[0], polygon.vertices[i - 1], polygon.vertices[i], flags | kClipped,
             other_side) == SetupResult::drawn) {
      emit(piece);
      any = true;
    }
  return any ? Fate::clipped : Fate::culled;
}

template <class Geometry, class Emit>
RASTRUM_HD Fate assemble_line(const Geometry& frame, const Draw& draw, std::uint64_t id,
                              std::uint32_t flags, PrimitiveCorners<2> c, Emit&& emit) {
  if (!c.finite) return Fate::dropped;
  if (c.needs_clip && !clip_line(c.clip, c.projected, frame.viewport)) return Fate::culled;
  Piece piece;
  if (make_line(c.projected[0], c.projected[1], id, flags, whole_width(draw.line_width),
                {0, 0, frame.width, frame.height}, piece) == SetupResult::culled)
    return Fate::culled;
  emit(piece);
  return c.needs_clip ? Fate::clipped : Fate::drawn;
}

template <class Geometry, class Emit>
RASTRUM_HD Fate assemble_point(const Geometry& frame, const Draw& draw, std::uint64_t id,
                               std::uint32_t flags, PrimitiveCorners<1> c, Emit&& emit) {
  const float size = draw.size_of(id - draw.first_id);
  if (!c.finite || !std::isfinite(size)) return Fate::dropped;
  if (c.needs_clip && !clip_point(c.clip[0], frame.viewport, c.projected[0])) return Fate::culled;
  Piece piece;
  if (draw.is_round()) flags |= kRound;
  if (make_point(c.projected[0], id, flags, point_size_fx8(size), {0, 0, frame.width, frame.height},
                 piece) == SetupResult::culled)
    return Fate::culled;
  emit(piece);
  return Fate::drawn;
}

/// At most two pieces. Their quadric lives during the call of `emit`.
template <class Emit>
Fate assemble_quadric(int width, int height, const Draw& draw, std::uint64_t p, std::uint32_t flags,
                      SampleOffset at, Emit&& emit) {
  QuadricShape shape;
  switch (draw.quadrics->shape(p, shape)) {
    case ShapeFate::dropped:
      return Fate::dropped;
    case ShapeFate::empty:
      return Fate::culled;
    case ShapeFate::drawn:
      break;
  }
  if (draw.quadrics->clip_to_object() == nullptr) return Fate::culled;
  Quadric quadric;
  QuadricPlace place;
  if (!make_quadric({*draw.quadrics, Viewport::of(width, height)}, shape, quadric, place))
    return Fate::culled;
  const Cull cull = draw.effective_cull();
  bool front = cull != Cull::front, back = cull != Cull::back;
  if (shape.kind == QuadricKind::disc) {
    front = front && place.front;
    back = back && !place.front;
  } else if (front && !quadric.is_open && !place.asks_near &&
             (flags & (kTested | kCut | kTranslucent)) == 0) {
    back = false;  // hidden
  }
  Piece piece;
  std::copy_n(place.x, 3, piece.x);
  std::copy_n(place.y, 3, piece.y);
  piece.flags = kQuadric;
  set_quadric(piece, &quadric);
  piece.low = kIdMask - (draw.first_id + p);
  piece = moved(piece, at);
  if (piece_bounds(piece, {0, 0, width, height}).empty()) return Fate::culled;
  for (const bool away : {false, true}) {
    if (!(away ? back : front)) continue;
    piece.flags = flags | kQuadric | (away ? kFacesAway : 0);
    emit(std::as_const(piece));
  }
  return front || back ? Fate::drawn : Fate::culled;
}

/// The piece of a triangle without clipping, as assemble_primitive makes it at pixel centres. False
/// for others, with nothing done. Indices must be in range.
template <class Geometry>
RASTRUM_HD bool assemble_unclipped(const Geometry& frame, const Draw& draw, std::uint64_t p,
                                   Fate& fate, Piece& piece) {
  if (draw.topology != Topology::triangles) return false;
  ProjectedVertex v[3];
  bool inside = true;
  for (int i = 0; i < 3; ++i) {
    v[i] = frame.vertex(draw, draw.vertex(p, i));
    inside = inside && v[i].x_fx8 != kNeedsClip;
  }
  if (!inside) return false;
  fate = Fate::culled;
  if (draw.visible && make_piece(v[0], v[1], v[2], draw.first_id + p, frame.flags_of(draw, p),
                                 draw.effective_cull(), {0, 0, frame.width, frame.height},
                                 piece) == SetupResult::drawn) {
    add_depth_bias(piece, draw.depth_bias, draw.depth_bias_slope);
    fate = Fate::drawn;
  }
  return true;
}

/// Calls emit(piece) for each piece, at most kMaxPieces, of primitive `p` of `draw` at sample
/// `sample`, whose offset is `at`. Returns what became of it (`clipped` ones are drawn). Indices
/// must be in range. `reach`: as in sample_bounds; it decides which triangles are left out.
template <class Geometry, class Emit>
RASTRUM_HD Fate assemble_primitive(const Geometry& frame, const Draw& draw, std::uint64_t p,
                                   Emit&& emit, std::uint32_t sample = 0, SampleOffset at = {},
                                   int reach = 0) {
  if (!draw.visible) return Fate::culled;
  const std::uint64_t id = draw.first_id + p;
  const std::uint32_t flags = frame.flags_of(draw, p) | sample << kSampleShift;
  if ((flags & kCutAway) != 0) return Fate::culled;
  const auto emit_biased = [&](Piece& piece) {
    add_depth_bias(piece, draw.depth_bias, draw.depth_bias_slope);
    emit(std::as_const(piece));
  };
#ifndef __CUDACC__
  // Only the host's frames have quadrics.
  if (draw.quadrics != nullptr)
    return assemble_quadric(frame.width, frame.height, draw, p, flags, at, emit);
#endif
  switch (draw.topology) {
    case Topology::points:
      return assemble_point(frame, draw, id, flags, PrimitiveCorners<1>(frame, draw, p),
                            emit_biased);
    case Topology::lines:
      return assemble_line(frame, draw, id, flags, PrimitiveCorners<2>(frame, draw, p),
                           emit_biased);
    case Topology::triangles:
      break;
  }
  return assemble_triangle(frame, draw, id, flags, PrimitiveCorners<3>(frame, draw, p), at, reach,
                           emit_biased);
}

}  // namespace rastrum::raster
