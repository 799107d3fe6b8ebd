#include "tests/support/pieces.hpp"

namespace rastrum::test {
namespace {

raster::Vec4d homogeneous(const ClipVertex& v) {
  return {v.x, v.y, v.z, v.w};
}

bool kept(bool front, Cull cull) {
  return cull == Cull::none || (cull == Cull::back) == front;
}

}  // namespace

raster::ClippedPolygon clip(const ProjectedTriangle& t, int width, int height) {
  raster::Vec4d corners[3];
  raster::ProjectedVertex positions[3];
  for (int i = 0; i < 3; ++i) {
    corners[i] = homogeneous(t.clip[i]);
    if (!t.has_position[i]) {
      positions[i].x_fx8 = raster::kNeedsClip;
      continue;
    }
    positions[i].x_fx8 = static_cast<std::int32_t>(t.snapped.v[i].x_fx8);
    positions[i].y_fx8 = static_cast<std::int32_t>(t.snapped.v[i].y_fx8);
    positions[i].depth = t.snapped.v[i].depth;
  }
  return raster::clip_triangle(corners, positions, raster::Viewport::of(width, height));
}

std::vector<SnappedTriangle> fan_of(const raster::ClippedPolygon& polygon, bool front,
                                    std::int64_t id) {
  std::vector<SnappedTriangle> out;
  const auto corner = [&](int i) {
    const raster::ProjectedVertex& v = polygon.vertices[i];
    return SnappedVertex{v.x_fx8, v.y_fx8, v.depth};
  };
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
      const raster::Vec4d corners[3] = {homogeneous(t.clip[0]), homogeneous(t.clip[1]),
                                        homogeneous(t.clip[2])};
      const double facing = raster::orientation(corners);
      if (facing == 0 || !kept((facing > 0) != t.mirrored, cull)) continue;
      for (const SnappedTriangle& p : fan_of(clip(t, width, height), facing > 0, t.id))
        out.triangles.push_back(p);
    }
  }
  return out;
}

}  // namespace rastrum::test
