// SPDX-License-Identifier: BSD-3-Clause
// Perspective-correct interpolation: f = Σ bᵢ fᵢ / Σ bᵢ with weights bᵢ that are linear on the
// screen. Computed in float64 from snapped positions or, for a clipped triangle, from the
// original's homogeneous positions (Olano and Greer, "Triangle scan conversion using 2D homogeneous
// coordinates", 1997), so that no attribute is ever clipped. SIMD shaders have a float32 form for
// triangles where that is as good. Templates on the geometry, as in assemble.hpp. A line's weights
// change with the major axis alone, as its depth does; a point has one weight.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <rastrum/program.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/rules/points_and_lines.hpp>

namespace rastrum::raster {

/// bᵢ(x, y) = r[i] + p[i] (x − x0) + q[i] (y − y0), in px.
struct WeightPlanes {
  double x0 = 0, y0 = 0;
  double p[3], q[3], r[3];
};

template <class Geometry>
RASTRUM_HD WeightPlanes line_weight_planes(const Geometry& frame, const Draw& draw,
                                           std::uint64_t line) {
  const std::uint32_t index[2] = {draw.vertex(line, 0), draw.vertex(line, 1)};
  const ProjectedVertex v0 = frame.vertex(draw, index[0]), v1 = frame.vertex(draw, index[1]);
  WeightPlanes w{};
  if (v0.x_fx8 != kNeedsClip && v1.x_fx8 != kNeedsClip) {
    constexpr double kPx = 1.0 / kSubpixels;
    const double dx = (v1.x_fx8 - v0.x_fx8) * kPx, dy = (v1.y_fx8 - v0.y_fx8) * kPx;
    const bool x_major = std::abs(dx) >= std::abs(dy);
    double(&along)[3] = x_major ? w.p : w.q;
    w.x0 = v0.x_fx8 * kPx;
    w.y0 = v0.y_fx8 * kPx;
    w.r[0] = v0.inv_w;
    along[0] = -v0.inv_w / (x_major ? dx : dy);
    along[1] = v1.inv_w / (x_major ? dx : dy);
    return w;
  }
  // With X = (b₀ x₀ + b₁ x₁) / (b₀ w₀ + b₁ w₁): b₀ : b₁ = X w₁ − x₁ : x₀ − X w₀, linear in X, the
  // NDC of the axis along which the line is longer on the screen.
  const Vec4d a = frame.clip_position(draw, index[0]), b = frame.clip_position(draw, index[1]);
  const double hw = frame.viewport.half_width;
  const double hh = frame.viewport.half_height;
  if (std::abs(a.x * b.w - b.x * a.w) * hw >= std::abs(a.y * b.w - b.y * a.w) * hh) {
    w.r[0] = -b.w - b.x;
    w.p[0] = b.w / hw;
    w.r[1] = a.x + a.w;
    w.p[1] = -a.w / hw;
  } else {
    w.r[0] = b.w - b.y;
    w.q[0] = -b.w / hh;
    w.r[1] = a.y - a.w;
    w.q[1] = a.w / hh;
  }
  return w;
}

template <class Geometry>
RASTRUM_HD WeightPlanes weight_planes(const Geometry& frame, const Draw& draw,
                                      const std::uint32_t (&index)[3]) {
  const ProjectedVertex v0 = frame.vertex(draw, index[0]), v1 = frame.vertex(draw, index[1]),
                        v2 = frame.vertex(draw, index[2]);
  WeightPlanes w;
  if (v0.x_fx8 != kNeedsClip && v1.x_fx8 != kNeedsClip && v2.x_fx8 != kNeedsClip) {
    constexpr double kPx = 1.0 / kSubpixels;
    const double e1x = (v1.x_fx8 - v0.x_fx8) * kPx, e1y = (v1.y_fx8 - v0.y_fx8) * kPx;
    const double e2x = (v2.x_fx8 - v0.x_fx8) * kPx, e2y = (v2.y_fx8 - v0.y_fx8) * kPx;
    const double inv_det = 1 / (e1x * e2y - e2x * e1y);
    w.x0 = v0.x_fx8 * kPx;
    w.y0 = v0.y_fx8 * kPx;
    const double p1 = e2y * inv_det, q1 = -e2x * inv_det;
    const double p2 = -e1y * inv_det, q2 = e1x * inv_det;
    w.r[0] = v0.inv_w;
    w.p[0] = -(p1 + p2) * v0.inv_w;
    w.q[0] = -(q1 + q2) * v0.inv_w;
    w.r[1] = w.r[2] = 0;
    w.p[1] = p1 * v1.inv_w;
    w.q[1] = q1 * v1.inv_w;
    w.p[2] = p2 * v2.inv_w;
    w.q[2] = q2 * v2.inv_w;
    return w;
  }
  Vec4d c[3];
  for (int i = 0; i < 3; ++i) c[i] = frame.clip_position(draw, index[i]);
  const double hw = frame.viewport.half_width;
  const double hh = frame.viewport.half_height;
  for (int i = 0; i < 3; ++i) {
    const Vec4d &a = c[(i + 1) % 3], &b = c[(i + 2) % 3];
    // The edge opposite vertex i as a function of NDC (X, Y, 1); X = x / hw − 1, Y = 1 − y / hh.
    const double ex = a.y * b.w - a.w * b.y;
    const double ey = a.w * b.x - a.x * b.w;
    const double ew = a.x * b.y - a.y * b.x;
    w.p[i] = ex / hw;
    w.q[i] = -ey / hh;
    w.r[i] = -ex + ey + ew;
  }
  return w;
}

template <class Geometry>
RASTRUM_HD WeightPlanes weight_planes(const Geometry& frame, const Draw& draw,
                                      std::uint64_t triangle) {
  std::uint32_t vertex[3];
  draw.vertices(triangle, vertex);
  return weight_planes(frame, draw, vertex);
}

/// Weights at a point of pixel (x, y), `from_centre` px from its centre. Snapping may put a sample
/// a little outside of a clipped triangle's exact shape, where thin ones would extrapolate wildly,
/// so weights are clamped to [0, 1]. Returns their sum before normalization.
RASTRUM_HD inline double shares_at(const WeightPlanes& w, int x, int y, Vec2 from_centre,
                                   double (&b)[3]) {
  const double dx = x + 0.5 + static_cast<double>(from_centre.x) - w.x0;
  const double dy = y + 0.5 + static_cast<double>(from_centre.y) - w.y0;
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    b[i] = w.r[i] + w.p[i] * dx + w.q[i] * dy;
    sum += b[i];
  }
  double inside = 0;
  for (double& share : b) {
    share /= sum;
    share = share > 0 ? (share < 1 ? share : 1.0) : 0.0;
    inside += share;
  }
  for (double& share : b) share /= inside;
  return sum;
}

RASTRUM_HD inline Weights weights_at(const WeightPlanes& w, int x, int y,
                                     Vec2 from_centre = {0, 0}) {
  Weights result;
  const double sum = shares_at(w, x, y, from_centre, result.b);
  double sum_dx = 0, sum_dy = 0;
  for (int i = 0; i < 3; ++i) {
    sum_dx += w.p[i];
    sum_dy += w.q[i];
  }
  for (int i = 0; i < 3; ++i) {
    result.db_dx[i] = (w.p[i] - result.b[i] * sum_dx) / sum;
    result.db_dy[i] = (w.q[i] - result.b[i] * sum_dy) / sum;
  }
  return result;
}

/// A pixel, and an offset from its centre in px.
struct PixelPoint {
  int x, y;
  Vec2 from_centre;
};
/// Element i of a block that begins at pixel (x0, y0); `points` as in VisibleBlock.
inline PixelPoint pixel_point(int x0, int y0, int i, const ShadingPoints* points) {
  PixelPoint at{x0 + i % kBlockSize, y0 + i / kBlockSize, {0, 0}};
  if (points == nullptr) return at;
  const Vec2 by{std::floor(points->dx[i] + 0.5F), std::floor(points->dy[i] + 0.5F)};
  at.x += static_cast<int>(by.x);
  at.y += static_cast<int>(by.y);
  at.from_centre = {points->dx[i] - by.x, points->dy[i] - by.y};
  return at;
}

struct LocatedFragment : Fragment {
  const WeightPlanes* planes = nullptr;
};

/// Finds the primitives and weights of fragments. Neighbours mostly share a primitive, whose planes
/// are kept.
class FragmentLocator {
 public:
  explicit FragmentLocator(const FrameGeometry& frame) : frame_(frame) {}

  /// The fragment of primitive `id` at element i of a block that begins at pixel (x0, y0); `points`
  /// as in VisibleBlock. Valid until the next call. Its depth is not set, nor, without `changes`,
  /// how the weights change across pixels.
  LocatedFragment& locate(std::uint64_t id, int x0, int y0, int i, const ShadingPoints* points,
                          bool changes = true) {
    const auto [x, y, from_centre] = pixel_point(x0, y0, i, points);
    if (id != fragment_.id || fragment_.planes == nullptr) {
      const Draw& draw = frame_.draw_of(id);
      square_px_ = 0;
      fragment_.id = id;
      const std::uint64_t primitive = id - draw.first_id;
      fragment_.triangle = primitive;
      fragment_.draw = static_cast<std::size_t>(&draw - frame_.draws.data());
      for (int c = 0; c < static_cast<int>(draw.topology); ++c)
        fragment_.vertex[c] = draw.vertex(fragment_.triangle, c);
      switch (draw.topology) {
        case Topology::points:
          planes_ = point_planes(draw);
          break;
        case Topology::lines:
          planes_ = line_weight_planes(frame_, draw, fragment_.triangle);
          break;
        case Topology::triangles:
          planes_ = weight_planes(frame_, draw, fragment_.triangle);
          break;
      }
      fragment_.front = draw.topology != Topology::triangles || is_front(draw);
      if (draw.is_copied()) {
        fragment_.triangle = draw.of_copy(primitive).primitive;
        for (std::uint32_t& v : fragment_.vertex) v %= draw.copies.vertices;
      }
      fragment_.planes = &planes_;
    }
    fragment_.x = x;
    fragment_.y = y;
    fragment_.from_centre = from_centre;
    if (changes)
      fragment_.weights = weights_at(planes_, x, y, fragment_.from_centre);
    else
      (void)shares_at(planes_, x, y, fragment_.from_centre, fragment_.weights.b);
    if (square_px_ > 0)
      fragment_.point = {static_cast<float>((x + 0.5 - planes_.x0) / square_px_),
                         static_cast<float>((y + 0.5 - planes_.y0) / square_px_)};
    return fragment_;
  }

 private:
  [[nodiscard]] bool is_front(const Draw& draw) const {
    const auto& index = fragment_.vertex;
    const ProjectedVertex v0 = frame_.vertex(draw, index[0]), v1 = frame_.vertex(draw, index[1]),
                          v2 = frame_.vertex(draw, index[2]);
    const auto clip = [&](int c) { return frame_.clip_position(draw, index[c]); };
    const bool counter_clockwise =
        v0.x_fx8 != kNeedsClip && v1.x_fx8 != kNeedsClip && v2.x_fx8 != kNeedsClip
            ? twice_area(v0, v1, v2) < 0
            : orientation({clip(0), clip(1), clip(2)}) > 0;
    return counter_clockwise != (draw.winding == Winding::clockwise);
  }

  /// One weight; the planes' origin is the square's top left.
  WeightPlanes point_planes(const Draw& draw) {
    ProjectedVertex v = frame_.vertex(draw, fragment_.vertex[0]);
    if (v.x_fx8 == kNeedsClip)
      (void)clip_point(frame_.clip_position(draw, fragment_.vertex[0]), frame_.viewport, v);
    constexpr double kPx = 1.0 / kSubpixels;
    square_px_ = point_size_fx8(draw.size_of(fragment_.triangle)) * kPx;
    WeightPlanes w{};
    w.x0 = v.x_fx8 * kPx - square_px_ / 2;
    w.y0 = v.y_fx8 * kPx - square_px_ / 2;
    w.r[0] = 1;
    return w;
  }

  const FrameGeometry& frame_;
  LocatedFragment fragment_;
  WeightPlanes planes_;
  double square_px_ = 0;  ///< a point's, else 0
};

/// A BlockShader from a function Vec4(const FrameGeometry&, const Fragment&) that returns a
/// fragment's premultiplied colour.
template <class F>
class FragmentShader final : public BlockShader {
 public:
  explicit FragmentShader(F f) : f_(std::move(f)) {}

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa,
             BlockColors& colors) const noexcept override {
    FragmentLocator locator(frame);
    bool opaque = true;
    for (std::uint64_t rest = block.covered; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const std::uint64_t key = block.keys[i];
      LocatedFragment fragment =
          locator.locate(id_of_key(key), block.x0, block.y0, i, block.points);
      fragment.depth = std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits));
      opaque &= colors.set(i, f_(frame, fragment));
    }
    return opaque;
  }

 private:
  F f_;
};

}  // namespace rastrum::raster
