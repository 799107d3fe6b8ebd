// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/point_line_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <rastrum/transform.hpp>

#include "tests/support/pieces.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test {
namespace {

/// The vertices of an instance, computed on request.
class Vertices {
 public:
  Vertices(const PointLineScene& scene, const InstanceView& instance)
      : width_(scene.width),
        height_(scene.height),
        matrix_(object_to_clip(scene.camera, instance.object_to_world, width_, height_)) {}

  struct Vertex : PieceCorner {
    bool finite = true;
  };
  [[nodiscard]] Vertex of(const ArrayView<Vec3>& positions, std::size_t i) const {
    Vertex v;
    const Vec3d p = positions.wide(i);
    v.finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    if (!v.finite) return v;
    v.clip = positions.is_wide() ? wide(p) : to_clip(matrix_, positions[i]);
    v.whole = snap(v.clip, width_, height_, v.snapped);
    return v;
  }

 private:
  /// In float64, rounded to float32 once.
  [[nodiscard]] ClipVertex wide(Vec3d p) const {
    const auto row = [&](int i) {
      const auto& m = matrix_.m[i];
      return static_cast<double>(
          static_cast<float>(((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3]));
    };
    return {row(0), row(1), row(2), row(3)};
  }

  int width_, height_;
  Mat4d matrix_;
};

void expect_points(PointLineScene& s, const InstanceView& instance, const PointsView& points) {
  const Vertices vertices(s, instance);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto id = static_cast<std::int64_t>(s.input++);
    const std::size_t k =
        points.indices.empty() ? i : static_cast<std::size_t>(points.indices.wide(i));
    const auto v = vertices.of(points.positions, k);
    const float size = points.sizes.empty() ? points.point_size : points.sizes[k];
    if (!v.finite || !std::isfinite(size)) {
      ++s.dropped;
      continue;
    }
    const auto p = point_of(v, s.width, s.height);
    if (!p) continue;
    const std::int64_t size_fx8 =
        std::llrint(std::clamp(static_cast<double>(size), 1.0, 4096.0) * 256);
    s.primitives.push_back({SnappedPoint{*p, size_fx8, id, points.round}, 0, 0});
  }
}

/// The first corners of a line's segments, by polyline.
std::vector<std::size_t> segment_corners(const LinesView& lines) {
  std::vector<std::size_t> first;
  const std::size_t corners = lines.corner_count();
  if (lines.kind == LineKind::segments) {
    for (std::size_t c = 0; c + 1 < corners; c += 2) first.push_back(c);
  } else if (lines.offsets.empty()) {
    for (std::size_t c = 0; c + 1 < corners; ++c) first.push_back(c);
  } else {
    for (std::size_t l = 0; l + 1 < lines.offsets.size(); ++l)
      for (std::size_t c = lines.offsets.wide(l); c + 1 < lines.offsets.wide(l + 1); ++c)
        first.push_back(c);
  }
  return first;
}

void expect_lines(PointLineScene& s, const InstanceView& instance, const LinesView& lines) {
  const Vertices vertices(s, instance);
  for (const std::size_t corner : segment_corners(lines)) {
    const auto id = static_cast<std::int64_t>(s.input++);
    const auto at = [&](std::size_t c) {
      return vertices.of(lines.positions, lines.indices.empty()
                                              ? c
                                              : static_cast<std::size_t>(lines.indices.wide(c)));
    };
    const auto a = at(corner), b = at(corner + 1);
    if (!a.finite || !b.finite) {
      ++s.dropped;
      continue;
    }
    const auto ends = line_of(a, b, s.width, s.height);
    if (!ends) continue;
    const int width = std::max(static_cast<int>(std::lrint(lines.line_width)), 1);
    s.primitives.push_back({SnappedLine{{(*ends)[0], (*ends)[1]}, width, id}, 0, 0});
  }
}

/// Triangles in front of the near plane.
void expect_triangles(PointLineScene& s, const InstanceView& instance, const MeshView& mesh) {
  const Vertices vertices(s, instance);
  for (std::size_t t = 0; t < mesh.positions.size() / 3; ++t) {
    SnappedTriangle triangle{{}, static_cast<std::int64_t>(s.input++)};
    for (std::size_t c = 0; c < 3; ++c)
      triangle.v[c] = vertices.of(mesh.positions, 3 * t + c).snapped;
    if (twice_area(triangle) != 0) s.primitives.push_back({triangle, 0, 0});
  }
}

Vec3 somewhere(Random& r, bool nasty) {
  Vec3 p{r.real32(-1.3, 1.3), r.real32(-1.1, 1.1), r.real32(-2, 0.5)};
  if (!nasty) return p;
  if (r.chance(0.06)) p.z = r.real32(1.9, 6);  // before the near plane, behind
  if (r.chance(0.03)) p.x *= 1e6F;             // beyond the guard band
  if (r.chance(0.03)) p.y = std::numeric_limits<float>::quiet_NaN();
  return p;
}

/// `count` positions of an instance and its optional attributes.
struct Arrays {
  ArrayView<Vec3> positions, normals;
  ArrayView<Vec4> colors;
  IndexView indices;
};

Arrays random_arrays(PointLineScene& s, Random& r, int count, int corners, bool indexed) {
  Arrays a;
  std::vector<Vec3>& p = s.positions.emplace_back();
  std::vector<Vec4>& c = s.colors.emplace_back();
  std::vector<Vec3>& n = s.normals.emplace_back();
  const bool nasty = r.chance(0.5);
  for (int i = 0; i < count; ++i) {
    p.push_back(somewhere(r, nasty));
    c.push_back({r.real32(0, 1), r.real32(0, 1), r.real32(0, 1), 1});
    n.push_back(somewhere(r, false));
  }
  if (r.chance(0.3)) {
    std::vector<Vec3d>& wide = s.wide_positions.emplace_back();
    for (const Vec3 v : p) wide.push_back(Vec3d(v) + Vec3d{1e-9, 0, 0});
    a.positions = wide;
  } else if (r.chance(0.3)) {
    a.positions =
        ArrayView<Vec3>::of(&p.back().x, p.size(), -static_cast<std::ptrdiff_t>(sizeof(Vec3)));
  } else {
    a.positions = p;
  }
  if (r.chance(0.6)) a.colors = c;
  if (r.chance(0.5)) a.normals = n;
  if (indexed) {
    std::vector<std::int64_t>& indices = s.indices.emplace_back();
    for (int i = 0; i < corners; ++i) indices.push_back(r.integer(0, count - 1));
    a.indices = indices;
  }
  return a;
}

PointsView random_points(PointLineScene& s, Random& r) {
  const int count = r.integer(1, 300);
  const bool indexed = r.chance(0.3);
  const Arrays a = random_arrays(s, r, count, r.integer(1, 300), indexed);
  PointsView points{.positions = a.positions,
                    .indices = a.indices,
                    .normals = a.normals,
                    .colors = a.colors,
                    .round = r.chance(0.5)};
  constexpr float kSizes[] = {1, 1, 0.3F, 1.49F, 1.5F, 2, 3, 3.01F, 7, 20.3F};
  points.point_size = kSizes[r.integer(0, 9)];
  if (r.chance(0.3)) {
    std::vector<float>& sizes = s.sizes.emplace_back();
    for (int i = 0; i < count; ++i) sizes.push_back(r.real32(-1, r.chance(0.2) ? 12 : 4));
    if (r.chance(0.3)) sizes[0] = std::numeric_limits<float>::quiet_NaN();
    points.sizes = sizes;
  }
  return points;
}

LinesView random_lines(PointLineScene& s, Random& r) {
  const int count = 2 * r.integer(1, 12), corners = 2 * r.integer(1, 12);
  const bool indexed = r.chance(0.4);
  const Arrays a = random_arrays(s, r, count, corners, indexed);
  LinesView lines{.positions = a.positions,
                  .indices = a.indices,
                  .colors = a.colors,
                  .line_width = static_cast<float>(r.chance(0.5) ? 1 : r.real(0.1, 7))};
  lines.kind = r.chance(0.5) ? LineKind::segments : LineKind::polylines;
  if (lines.kind == LineKind::polylines && r.chance(0.7)) {
    std::vector<std::uint16_t>& offsets = s.offsets.emplace_back();
    const auto most = static_cast<int>(lines.corner_count());
    for (int at = r.integer(0, 1); at <= most; at += r.integer(1, 5))
      offsets.push_back(static_cast<std::uint16_t>(at));
    lines.offsets = offsets;
    if (offsets.size() < 2) lines.offsets = {};
  }
  return lines;
}

}  // namespace

PointLineScene generate_points_and_lines(std::uint64_t seed, int width, int height) {
  Random r(seed);
  PointLineScene s;
  s.width = width;
  s.height = height;
  s.camera.eye = {r.real(-0.3, 0.3), r.real(-0.3, 0.3), 1.8};
  s.camera.target = {0, 0, 0};
  s.camera.orthographic = r.chance(0.3);
  s.camera.orthographic_height = 2.2F;
  s.camera.near_plane = 0.1F;
  if (s.camera.orthographic) s.camera.far_plane = 9;
  for (int i = r.integer(1, 5); i > 0; --i) {
    Mat4d place = Mat4d::identity();
    const int kind = r.integer(0, 4);
    if (r.chance(0.4) && kind < 4)
      place = translation({r.real(-0.4, 0.4), 0, 0}) * scaling({1, 1.25, 0.75});
    if (kind < 2) {
      s.instances.add(random_points(s, r), place);
    } else if (kind < 4) {
      s.instances.add(random_lines(s, r), place);
    } else {
      std::vector<Vec3>& p = s.positions.emplace_back();
      for (int k = 3 * r.integer(1, 6); k > 0; --k) p.push_back(somewhere(r, false));
      s.instances.add(MeshView{.positions = p}, place);
    }
  }
  for (const InstanceView& instance : s.instances) {
    if (const auto* const p = instance.geometry.get_if<PointsView>())
      expect_points(s, instance, *p);
    else if (const auto* const l = instance.geometry.get_if<LinesView>())
      expect_lines(s, instance, *l);
    else
      expect_triangles(s, instance, *instance.mesh());
  }
  return s;
}

}  // namespace rastrum::test
