// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/draws/cut.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/rules/quadric_surface.hpp>

namespace rastrum::raster {
namespace {

/// The balls about its ends, enlarged a little, tell on which side of a plane a quadric lies.
std::uint32_t quadric_cut_flags(const DrawCut& cut, const QuadricStage& stage,
                                std::uint64_t primitive) {
  QuadricShape shape;
  if (stage.shape(primitive, shape) != ShapeFate::drawn) return 0;
  const bool has_two = has_two_ends(shape.kind);
  std::uint32_t flags = 0;
  for (const DrawCut::Plane& plane : cut.planes) {
    const double scale = length(Vec3d{plane.x, plane.y, plane.z}) * (1 + 1e-9);
    const double ahead[2] = {DrawCut::ahead(plane, shape.p0),
                             DrawCut::ahead(plane, has_two ? shape.p1 : shape.p0)};
    const double reach[2] = {shape.r0 * scale, (has_two ? shape.r1 : shape.r0) * scale};
    if (ahead[0] < -reach[0] && ahead[1] < -reach[1]) return kCutAway;
    // A NaN makes each fragment be tested.
    if (!(ahead[0] > reach[0] && ahead[1] > reach[1])) flags = kCut;
  }
  return flags;
}

/// Where sample `i` of a block is tested.
struct SamplePlace {
  int x, y;
  Vec2 from_centre;

  SamplePlace(const Block& block, const ShadingPoints* points, int i)
      : x(block.bx * kBlockSize + i % kBlockSize),
        y(block.by * kBlockSize + i / kBlockSize),
        from_centre(points == nullptr ? Vec2{0, 0} : Vec2{points->dx[i], points->dy[i]}) {}
};

std::uint64_t quadric_in_front(const FrameGeometry& frame, const Draw& draw, const Piece& piece,
                               const Block& block, const ShadingPoints* points) {
  QuadricSurface surface;
  if (!surface.find(*draw.quadrics, id_of_key(piece.low) - draw.first_id, frame.viewport)) return 0;
  const bool away = (piece.flags & kFacesAway) != 0;
  std::uint64_t kept = 0;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const SamplePlace sample(block, points, i);
    const QuadricSurface::Place at = surface.at(sample.x, sample.y, sample.from_centre);
    const RayFrame::Point h = surface.point(at, surface.side(away, at).e);
    const bool keep = std::ranges::all_of(draw.cut->planes, [&](const DrawCut::Plane& p) {
      const double value = ((p.x * h.v.x + p.y * h.v.y) + p.z * h.v.z) + p.offset * h.w;
      return h.w < 0 ? value <= 0 : value >= 0;
    });
    kept |= std::uint64_t{keep} << i;
  }
  return kept;
}

}  // namespace

DrawCut::DrawCut(const InstanceView& instance, std::span<const ClipPlane> world) {
  if (const VertexList vertices = vertices_of(instance.geometry); vertices.positions != nullptr)
    positions = *vertices.positions;
  planes.reserve(world.size() + instance.clip_planes.size());
  const auto& m = instance.object_to_world.m;
  for (const ClipPlane& p : world) {
    // n · (M v) + offset.
    const auto column = [&](int j) {
      return (p.normal.x * m[0][j] + p.normal.y * m[1][j]) + p.normal.z * m[2][j];
    };
    planes.push_back({column(0), column(1), column(2), column(3) + p.offset});
  }
  for (const ClipPlane& p : instance.clip_planes)
    planes.push_back({p.normal.x, p.normal.y, p.normal.z, p.offset});
}

void check_clip_planes(std::span<const ClipPlane> planes, const char* whose) {
  const auto refuse = [&](const std::string& problem) {
    throw Error(Errc::invalid_argument, std::string(whose).append(problem));
  };
  if (planes.size() > kMaxClipPlanes)
    refuse(std::to_string(planes.size()) + " clip planes; there are at most " +
           std::to_string(kMaxClipPlanes));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::string name = "clip plane " + std::to_string(i);
    if (!is_finite(planes[i].normal) || !std::isfinite(planes[i].offset))
      refuse(name + " is not finite");
    if (planes[i].normal == Vec3d{}) refuse(name + " has no direction: its normal is 0");
  }
}

/// Indices must be in range.
std::uint32_t FrameGeometry::cut_flags(const Draw& draw, std::uint64_t primitive) noexcept {
  if (draw.quadrics != nullptr) return quadric_cut_flags(*draw.cut, *draw.quadrics, primitive);
  const int corners = static_cast<int>(draw.topology);
  std::uint32_t flags = 0;
  for (const DrawCut::Plane& plane : draw.cut->planes) {
    int kept = 0;
    for (int c = 0; c < corners; ++c)
      kept += draw.cut->ahead(plane, draw.vertex(primitive, c)) >= 0 ? 1 : 0;
    if (kept == 0) return kCutAway;
    if (kept < corners) flags = kCut;
  }
  return flags;
}

std::uint64_t in_front(const FrameGeometry& frame, const Piece& piece, const Block& block,
                       const ShadingPoints* points) noexcept {
  const std::uint64_t id = id_of_key(piece.low);
  const Draw& draw = frame.draw_of(id);
  if (draw.quadrics != nullptr) return quadric_in_front(frame, draw, piece, block, points);
  const std::uint64_t primitive = id - draw.first_id;
  const int corners = static_cast<int>(draw.topology);
  const WeightPlanes w = corners == 3 ? weight_planes(frame, draw, primitive)
                                      : line_weight_planes(frame, draw, primitive);
  /// Linear on the screen.
  struct Linear {
    double p = 0, q = 0, r = 0;
    void add(const WeightPlanes& planes, int corner, double times) {
      p += planes.p[corner] * times;
      q += planes.q[corner] * times;
      r += planes.r[corner] * times;
    }
    [[nodiscard]] double at(double x, double y) const { return p * x + q * y + r; }
  };
  // A clipped triangle may have only negative weights.
  Linear all;
  for (int c = 0; c < corners; ++c) all.add(w, c, 1);
  std::uint64_t mask = block.mask;
  for (const DrawCut::Plane& plane : draw.cut->planes) {
    Linear ahead;
    for (int c = 0; c < corners; ++c)
      ahead.add(w, c, draw.cut->ahead(plane, draw.vertex(primitive, c)));
    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const SamplePlace sample(block, points, i);
      const double x = sample.x + 0.5 - w.x0 + static_cast<double>(sample.from_centre.x);
      const double y = sample.y + 0.5 - w.y0 + static_cast<double>(sample.from_centre.y);
      const double value = ahead.at(x, y);
      // A NaN is not kept.
      if (!(all.at(x, y) < 0 ? value <= 0 : value >= 0)) mask ^= std::uint64_t{1} << i;
    }
  }
  return mask;
}

}  // namespace rastrum::raster
