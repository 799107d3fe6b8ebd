// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/seen_part.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace rastrum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The nearest end counts as at least this part of the farthest, so that each of four slices ends
/// at most 8 times as far as it begins.
constexpr double kNearest = 1.0 / 4096;

HalfSpace sum(const HalfSpace& p, const HalfSpace& q, double times) {
  return {p.a + q.a * times, p.b + q.b * times};
}
HalfSpace row_of(const Mat4d& m, int i) {
  return {{m.m[i][0], m.m[i][1], m.m[i][2]}, m.m[i][3]};
}

/// Sutherland–Hodgman clipping.
void clip(std::vector<Vec3d>& polygon, const HalfSpace& side) {
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = side(p), at_q = side(q);
    if (at_p >= 0) kept.push_back(p);
    if ((at_p < 0) != (at_q < 0)) kept.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  polygon = std::move(kept);
}

/// The pyramid, or prism, that a picture sees: across, up, and along the view axis.
class Pyramid {
 public:
  Pyramid(const Camera& camera, int width, int height)
      : clip_(world_to_clip(camera, width, height)),
        w_(row_of(clip_, 3)),
        is_parallel_(!(dot(w_.a, w_.a) > 0)) {
    const HalfSpace z = row_of(clip_, 2);
    // Distance: w, or for a parallel projection w − z, which is 0 at the near plane.
    far_ = is_parallel_ ? HalfSpace{-z.a, w_.b - z.b} : w_;
    unit_ = length(far_.a);
    if (is_parallel_) return;
    // At the near plane z = w. Where z and w are parallel, z = k w + c.
    const double k = dot(z.a, w_.a) / dot(w_.a, w_.a);
    near_ = (z.b - k * w_.b) / (1 - k);
    if (!(near_ > 0) || !std::isfinite(near_)) near_ = 0;
  }
  [[nodiscard]] bool is_parallel() const { return is_parallel_; }
  /// The distance; `unit` of it make one unit of the world.
  [[nodiscard]] const HalfSpace& far() const { return far_; }
  [[nodiscard]] double unit() const { return unit_; }
  [[nodiscard]] double near() const { return near_; }
  /// None where the matrix is singular.
  [[nodiscard]] std::optional<Hexahedron> slice(double first, double last) const {
    const HalfSpace x = row_of(clip_, 0), y = row_of(clip_, 1);
    Mat4d axes = Mat4d::identity();
    const HalfSpace* const rows[3] = {&x, &y, &far_};
    for (int i = 0; i < 3; ++i) {
      axes.m[i][0] = rows[i]->a.x;
      axes.m[i][1] = rows[i]->a.y;
      axes.m[i][2] = rows[i]->a.z;
      axes.m[i][3] = rows[i]->b;
    }
    const std::optional<Mat4d> back = inverse(axes);
    if (!back) return std::nullopt;
    Hexahedron h{{sum(w_, x, 1), sum(w_, x, -1), sum(w_, y, 1), sum(w_, y, -1),
                  HalfSpace{far_.a, far_.b - first}, HalfSpace{-far_.a, last - far_.b}},
                 {}};
    for (int k = 0; k < 8; ++k) {
      const double distance = (k & 4) != 0 ? last : first;
      const double w = is_parallel_ ? w_.b : distance;
      const double p[4] = {(k & 1) != 0 ? w : -w, (k & 2) != 0 ? w : -w, distance, 1};
      double q[3] = {};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) q[i] += back->m[i][j] * p[j];
      h.corners[k] = {q[0], q[1], q[2]};
    }
    return h;
  }

 private:
  Mat4d clip_;
  HalfSpace w_, far_;
  bool is_parallel_;
  double unit_ = 1, near_ = 0;
};

struct Range {
  double least = kInfinity, most = -kInfinity;
};
Range range_of(const HalfSpace& far, std::span<const Vec3d> points) {
  Range r;
  for (const Vec3d& p : points) {
    r.least = std::min(r.least, far(p));
    r.most = std::max(r.most, far(p));
  }
  return r;
}

}  // namespace

Hexahedron box_of(Vec3d low, Vec3d high) {
  Hexahedron h{{{{1, 0, 0}, -low.x},
                {{-1, 0, 0}, high.x},
                {{0, 1, 0}, -low.y},
                {{0, -1, 0}, high.y},
                {{0, 0, 1}, -low.z},
                {{0, 0, -1}, high.z}},
               {}};
  for (int k = 0; k < 8; ++k)
    h.corners[k] = {(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                    (k & 4) != 0 ? high.z : low.z};
  return h;
}

// A corner of the common part lies on a face of one part and inside all others.
std::vector<Vec3d> common_corners(std::span<const Hexahedron> parts) {
  std::vector<Vec3d> corners;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (int end = 0; end < 2; ++end) {
        std::vector<Vec3d> face;
        for (const int k : {0, 1, 3, 2})
          face.push_back(parts[i].corners[end << axis | (k & 1) << (axis + 1) % 3 |
                                          (k >> 1) << (axis + 2) % 3]);
        for (std::size_t j = 0; j < parts.size(); ++j)
          for (int side = 0; side < 6 && j != i; ++side) clip(face, parts[j].sides[side]);
        corners.insert(corners.end(), face.begin(), face.end());
      }
  return corners;
}

Hexahedron frustum(const Camera& camera, double first, double last) {
  return Pyramid(camera, 1, 1).slice(first, last).value_or(Hexahedron{});
}

std::vector<Hexahedron> seen_slices(Vec3d low, Vec3d high, const Camera& camera, int width,
                                    int height, double reach) {
  const Pyramid view(camera, width, height);
  const Hexahedron box = box_of(low, high);
  Range range = range_of(view.far(), box.corners);
  range.least = std::max(range.least, view.near());
  if (reach > 0) range.most = std::min(range.most, reach * view.unit());
  if (!(range.least <= range.most)) return {};
  // A margin, so that a flat scene does not fall between two slices.
  const auto seen = [&](double first, double last) {
    const double margin = 1e-9 * (std::abs(first) + std::abs(last));
    return view.slice(first - margin, last + margin).value_or(box);
  };
  const Hexahedron all = seen(range.least, range.most);
  const std::vector<Vec3d> corners = common_corners(std::vector{box, all});
  if (corners.empty()) return {};
  if (view.is_parallel()) return {all};
  range = range_of(view.far(), corners);
  const double nearest = std::max(range.least, range.most * kNearest);
  const double times = range.most / nearest;
  if (!(times > 6)) return {all};
  const int n = times > 16 ? 4 : 2;
  const double step = n == 2 ? std::sqrt(times) : std::sqrt(std::sqrt(times));
  std::vector<Hexahedron> slices;
  double first = range.least, last = nearest;
  for (int i = 0; i < n; ++i) {
    last = i + 1 == n ? range.most : last * step;
    slices.push_back(seen(first, last));
    first = last;
  }
  return slices;
}

}  // namespace rastrum
