// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/pieces.hpp"

namespace rastrum::test {
namespace {

raster::Vec4d homogeneous(const ClipVertex& v) {
  return {v.x, v.y, v.z, v.w};
}
raster::ProjectedVertex projected(const PieceCorner& c) {
  raster::ProjectedVertex p;
  p.x_fx8 = raster::kNeedsClip;
  if (c.whole)
    p = {static_cast<std::int32_t>(c.snapped.x_fx8), static_cast<std::int32_t>(c.snapped.y_fx8),
         c.snapped.depth, 0};
  return p;
}
SnappedVertex snapped(const raster::ProjectedVertex& v) {
  return {v.x_fx8, v.y_fx8, v.depth};
}

bool kept(bool front, Cull cull) {
  return cull == Cull::none || (cull == Cull::back) == front;
}

}  // namespace

std::optional<SnappedVertex> point_of(const PieceCorner& p, int width, int height) {
  raster::ProjectedVertex v = projected(p);
  const auto viewport = raster::Viewport::of(width, height);
  if (!p.whole && !raster::clip_point(homogeneous(p.clip), viewport, v)) return {};
  return snapped(v);
}

std::optional<std::array<SnappedVertex, 2>> line_of(const PieceCorner& a, const PieceCorner& b,
                                                    int width, int height) {
  const raster::Vec4d clip[2] = {homogeneous(a.clip), homogeneous(b.clip)};
  raster::ProjectedVertex ends[2] = {projected(a), projected(b)};
  const auto viewport = raster::Viewport::of(width, height);
  if ((!a.whole || !b.whole) && !raster::clip_line(clip, ends, viewport)) return {};
  return {{snapped(ends[0]), snapped(ends[1])}};
}

double facing_of(const ProjectedTriangle& t) {
  return raster::orientation(
      {homogeneous(t.clip[0]), homogeneous(t.clip[1]), homogeneous(t.clip[2])});
}

raster::ClippedPolygon clip(const ProjectedTriangle& t, int width, int height) {
  raster::Vec4d corners[3];
  raster::ProjectedVertex positions[3];
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = homogeneous(t.clip[i]);
    positions[i] = projected(corner_of(t, i));
  }
  return raster::clip_triangle(corners, positions, raster::Viewport::of(width, height));
}

std::vector<SnappedTriangle> fan_of(const raster::ClippedPolygon& polygon, bool front,
                                    std::int64_t id) {
  std::vector<SnappedTriangle> out;
  const auto corner = [&](int i) { return snapped(polygon.vertices[i]); };
  for (int i = 2; i < polygon.size; ++i) {
    const SnappedTriangle t{{corner(0), corner(i - 1), corner(i)}, id};
    const std::int64_t area = twice_area(t);
    if (area != 0 && (area < 0) == front) out.push_back(t);
  }
  return out;
}

PieceList pieces_of(const SceneView& scene, const Camera& camera, int width, int height,
                    Cull cull) {
  PieceList out;
  for (const ProjectedTriangle& t : project(scene, camera, width, height)) {
    ++out.input;
    if (t.fate == Fate::dropped) {
      ++out.dropped;
    } else if (t.fate == Fate::whole) {
      const std::int64_t area = twice_area(t.snapped);
      if (area != 0 && kept((area < 0) != t.mirrored, cull)) out.triangles.push_back(t.snapped);
    } else {
      ++out.clipped;
      const double facing = facing_of(t);
      if (facing == 0 || !kept((facing > 0) != t.mirrored, cull)) continue;
      for (const SnappedTriangle& p : fan_of(clip(t, width, height), facing > 0, t.id))
        out.triangles.push_back(p);
    }
  }
  return out;
}

}  // namespace rastrum::test
