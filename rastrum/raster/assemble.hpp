// From a triangle of a draw to its pieces: the slow, complete path (clipper included), used by the
// reference rasterizer for every triangle and by the fast ones for triangles that need clipping.
#pragma once

#include <cmath>

#include <rastrum/raster/geometry.hpp>
#include <rastrum/raster/setup.hpp>

namespace rastrum::raster {

enum class TriangleFate : std::uint8_t { drawn, clipped, culled, dropped };

/// Calls emit(piece) for each piece of triangle `t` of `draw`; says what became of the triangle
/// (`clipped` triangles are drawn too). Indices must be in range.
template <class Emit>
TriangleFate assemble_triangle(const FrameGeometry& frame, const Draw& draw, std::uint64_t t,
                               Cull cull, Emit&& emit) {
  const Rect view{0, 0, frame.width, frame.height};
  const std::uint64_t id = draw.first_id + t;
  const std::uint32_t index[3] = {draw.vertex(t, 0), draw.vertex(t, 1), draw.vertex(t, 2)};
  const ProjectedVertex v[3] = {frame.vertex(draw, index[0]), frame.vertex(draw, index[1]),
                                frame.vertex(draw, index[2])};
  Piece piece;
  if (v[0].x_fx8 != kNeedsClip && v[1].x_fx8 != kNeedsClip && v[2].x_fx8 != kNeedsClip) {
    if (make_piece(v[0], v[1], v[2], id, draw.flags, cull, view, piece) == SetupResult::culled)
      return TriangleFate::culled;
    emit(piece);
    return TriangleFate::drawn;
  }

  Vec4d clip[3];
  for (int i = 0; i < 3; ++i) {
    clip[i] = draw.source->clip_position(index[i]);
    if (!std::isfinite(clip[i].x) || !std::isfinite(clip[i].y) || !std::isfinite(clip[i].z) ||
        !std::isfinite(clip[i].w))
      return TriangleFate::dropped;
  }
  const double facing = orientation(clip);
  if (facing == 0 || (cull == Cull::back && facing < 0) || (cull == Cull::front && facing > 0))
    return TriangleFate::culled;
  const ClippedPolygon polygon = clip_triangle(clip, v, frame.viewport);
  // Snapping may turn a sliver of the polygon over; only pieces that face as the triangle does
  // count.
  const Cull other_side = facing > 0 ? Cull::back : Cull::front;
  bool any = false;
  for (int i = 2; i < polygon.size; ++i)
    if (make_piece(polygon.vertices[0], polygon.vertices[i - 1], polygon.vertices[i], id,
                   draw.flags, other_side, view, piece) == SetupResult::drawn) {
      emit(piece);
      any = true;
    }
  return any ? TriangleFate::clipped : TriangleFate::culled;
}

}  // namespace rastrum::raster
