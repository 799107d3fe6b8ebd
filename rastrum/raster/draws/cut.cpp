#include <rastrum/raster/draws/cut.hpp>

#include <bit>
#include <cmath>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/raster/shade/interpolate.hpp>

namespace rastrum::raster {

DrawCut::DrawCut(const InstanceView& instance, std::span<const ClipPlane> world,
                 const ArrayView<Vec3>& vertices)
    : positions(vertices) {
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

std::uint64_t in_front(const FrameGeometry& frame, std::uint64_t id, const Block& block,
                       const ShadingPoints* points) noexcept {
  const Draw& draw = frame.draw_of(id);
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
  // The weights of a clipped triangle may all be negative.
  Linear all;
  for (int c = 0; c < corners; ++c) all.add(w, c, 1);
  std::uint64_t mask = block.mask;
  for (const DrawCut::Plane& plane : draw.cut->planes) {
    Linear ahead;
    for (int c = 0; c < corners; ++c)
      ahead.add(w, c, draw.cut->ahead(plane, draw.vertex(primitive, c)));
    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      double x = block.bx * kBlockSize + i % kBlockSize + 0.5 - w.x0;
      double y = block.by * kBlockSize + i / kBlockSize + 0.5 - w.y0;
      if (points != nullptr) {
        x += static_cast<double>(points->dx[i]);
        y += static_cast<double>(points->dy[i]);
      }
      const double value = ahead.at(x, y);
      // Written so that a NaN is not kept.
      if (!(all.at(x, y) < 0 ? value <= 0 : value >= 0)) mask ^= std::uint64_t{1} << i;
    }
  }
  return mask;
}

}  // namespace rastrum::raster
