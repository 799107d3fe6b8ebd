// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace rastrum::test {
namespace {

// 2⁻¹⁵…2¹⁶ px in n.8. Differences stay below 2²⁵, their products below 2⁵¹.
constexpr std::int64_t kGuardMin = -(std::int64_t{1} << 23);
constexpr std::int64_t kGuardMax = std::int64_t{1} << 24;

std::int64_t sample_fx8(int pixel) {
  return std::int64_t{pixel} * 256 + 128;
}

// Whether p is inside the edge a → b of a triangle that is clockwise on the screen (y down). A
// point on the edge belongs to it only if the edge is a top edge (to the right) or a left edge
// (upwards).
bool inside_edge(const SnappedVertex& a, const SnappedVertex& b, std::int64_t x, std::int64_t y) {
  const std::int64_t dx = b.x_fx8 - a.x_fx8;
  const std::int64_t dy = b.y_fx8 - a.y_fx8;
  const std::int64_t e = dx * (y - a.y_fx8) - dy * (x - a.x_fx8);
  if (e != 0) return e > 0;
  const bool top = dy == 0 && dx > 0;
  const bool left = dy < 0;
  return top || left;
}

void require_guard_band(std::span<const SnappedVertex> vertices) {
  for (const SnappedVertex& v : vertices)
    if (v.x_fx8 < kGuardMin || v.x_fx8 > kGuardMax || v.y_fx8 < kGuardMin || v.y_fx8 > kGuardMax)
      throw std::out_of_range("oracle: a vertex outside the guard band");
}

/// c₀ + c₁ ε + c₂ ε² + … for an infinitesimal ε > 0. It is exact: its sign is that of the first
/// non-zero coefficient.
class Perturbed {
 public:
  Perturbed(std::int64_t c0 = 0, std::int64_t c1 = 0, std::int64_t c2 = 0) : c_{c0, c1, c2, 0, 0} {}

  friend Perturbed operator+(Perturbed a, const Perturbed& b) {
    for (std::size_t i = 0; i < kTerms; ++i) a.c_[i] += b.c_[i];
    return a;
  }
  friend Perturbed operator-(Perturbed a, const Perturbed& b) {
    for (std::size_t i = 0; i < kTerms; ++i) a.c_[i] -= b.c_[i];
    return a;
  }
  friend Perturbed operator*(const Perturbed& a, const Perturbed& b) {
    Perturbed product;
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; i + j < kTerms; ++j) product.c_[i + j] += a.c_[i] * b.c_[j];
    return product;
  }
  [[nodiscard]] int sign() const {
    for (const Int128 c : c_)
      if (c != 0) return c > 0 ? 1 : -1;
    return 0;
  }

 private:
  __extension__ using Int128 = __int128;
  static constexpr std::size_t kTerms = 5;  // enough for a product of two points
  Int128 c_[kTerms];
};

struct PerturbedPoint {
  Perturbed x, y;
};

/// The open diamond |x − x_f| + |y − y_f| < 128 around a sample, n.8.
struct Diamond {
  std::int64_t x_f, y_f;

  [[nodiscard]] bool contains(const PerturbedPoint& p) const {
    for (const int sx : {-1, 1})
      for (const int sy : {-1, 1})
        if (beyond(p, sx, sy)) return false;
    return true;
  }
  /// Two convex sets meet unless a line along a side of one separates them.
  [[nodiscard]] bool meets(const PerturbedPoint& a, const PerturbedPoint& b) const {
    for (const int sx : {-1, 1})
      for (const int sy : {-1, 1})
        if (beyond(a, sx, sy) && beyond(b, sx, sy)) return false;
    bool left = false, right = false;
    for (const auto& [dx, dy] : {std::pair{-128, 0}, {128, 0}, {0, -128}, {0, 128}}) {
      const Perturbed cross =
          (b.x - a.x) * (Perturbed(y_f + dy) - a.y) - (b.y - a.y) * (Perturbed(x_f + dx) - a.x);
      left |= cross.sign() < 0;
      right |= cross.sign() > 0;
    }
    return left && right;
  }

 private:
  [[nodiscard]] bool beyond(const PerturbedPoint& p, int sx, int sy) const {
    const Perturbed d =
        (p.x - Perturbed(x_f)) * Perturbed(sx) + (p.y - Perturbed(y_f)) * Perturbed(sy);
    return (d - Perturbed(128)).sign() >= 0;
  }
};

/// Depth at a sample: z0 at (x0, y0) px and its change per px.
struct Plane {
  float z0, zx, zy, x0, y0;
};

Plane plane_at(const SnappedVertex& origin, double zx, double zy) {
  return {origin.depth, static_cast<float>(zx), static_cast<float>(zy),
          static_cast<float>(origin.x_fx8) / 256, static_cast<float>(origin.y_fx8) / 256};
}

Plane plane_of(const SnappedTriangle& t) {
  const double dz1 = double{t.v[1].depth} - double{t.v[0].depth};
  const double dz2 = double{t.v[2].depth} - double{t.v[0].depth};
  const double dx1 = static_cast<double>(t.v[1].x_fx8 - t.v[0].x_fx8);
  const double dy1 = static_cast<double>(t.v[1].y_fx8 - t.v[0].y_fx8);
  const double dx2 = static_cast<double>(t.v[2].x_fx8 - t.v[0].x_fx8);
  const double dy2 = static_cast<double>(t.v[2].y_fx8 - t.v[0].y_fx8);
  const double det = static_cast<double>(twice_area(t));
  return plane_at(t.v[0], 256 * (dz1 * dy2 - dz2 * dy1) / det, 256 * (dz2 * dx1 - dz1 * dx2) / det);
}

Plane plane_of(const SnappedLine& l) {
  const double dz = double{l.v[1].depth} - double{l.v[0].depth};
  const double dx = static_cast<double>(l.v[1].x_fx8 - l.v[0].x_fx8);
  const double dy = static_cast<double>(l.v[1].y_fx8 - l.v[0].y_fx8);
  if (std::abs(dx) >= std::abs(dy)) return plane_at(l.v[0], 256 * dz / dx, 0);
  return plane_at(l.v[0], 0, 256 * dz / dy);
}

Plane plane_of(const SnappedPoint& p) {
  return plane_at(p.v, 0, 0);
}

float depth_at(const Plane& plane, std::int64_t x_fx8, std::int64_t y_fx8) {
  const float along_x = plane.zx * (static_cast<float>(x_fx8) / 256 - plane.x0);
  const float along_y = plane.zy * (static_cast<float>(y_fx8) / 256 - plane.y0);
  const float d = (plane.z0 + along_x) + along_y;
  if (!(d > 0)) return 0.0F;
  return d < 1 ? d : 1.0F;
}

}  // namespace

std::uint64_t visibility_key(float depth, std::int64_t id) {
  const std::uint64_t bits = std::bit_cast<std::uint32_t>(depth);
  return bits << 33 | ((std::uint64_t{1} << 33) - 1 - static_cast<std::uint64_t>(id));
}

std::uint64_t OracleImage::fragments() const {
  return std::accumulate(overdraw.begin(), overdraw.end(), std::uint64_t{0});
}

std::uint64_t OracleImage::pixels_covered() const {
  return static_cast<std::uint64_t>(
      std::count_if(overdraw.begin(), overdraw.end(), [](std::uint32_t n) { return n > 0; }));
}

std::uint64_t OracleImage::pixels_of(const SnappedPrimitive& p) const {
  const std::int64_t id = std::visit([](const auto& shape) { return shape.id; }, p.shape);
  return static_cast<std::uint64_t>(std::count(ids.begin(), ids.end(), id));
}

std::int64_t twice_area(const SnappedTriangle& t) {
  const std::int64_t dx1 = t.v[1].x_fx8 - t.v[0].x_fx8, dy1 = t.v[1].y_fx8 - t.v[0].y_fx8;
  const std::int64_t dx2 = t.v[2].x_fx8 - t.v[0].x_fx8, dy2 = t.v[2].y_fx8 - t.v[0].y_fx8;
  return dx1 * dy2 - dx2 * dy1;
}

bool covers(const SnappedTriangle& t, int px, int py) {
  return covers_sample(t, sample_fx8(px), sample_fx8(py));
}

bool covers_sample(const SnappedTriangle& t, std::int64_t x, std::int64_t y) {
  const std::int64_t area = twice_area(t);
  if (area == 0) return false;
  const SnappedVertex& a = t.v[0];
  const SnappedVertex& b = area > 0 ? t.v[1] : t.v[2];
  const SnappedVertex& c = area > 0 ? t.v[2] : t.v[1];
  return inside_edge(a, b, x, y) && inside_edge(b, c, x, y) && inside_edge(c, a, x, y);
}

bool covers(const SnappedLine& l, int px, int py) {
  const bool x_major =
      std::abs(l.v[1].x_fx8 - l.v[0].x_fx8) >= std::abs(l.v[1].y_fx8 - l.v[0].y_fx8);
  const std::int64_t shift = (l.width - 1) * 128;
  const auto moved = [&](const SnappedVertex& v) {
    return PerturbedPoint{Perturbed(v.x_fx8 - (x_major ? 0 : shift), -1, 0),
                          Perturbed(v.y_fx8 - (x_major ? shift : 0), 0, -1)};
  };
  const PerturbedPoint a = moved(l.v[0]), b = moved(l.v[1]);
  for (int k = 0; k < l.width; ++k) {
    const Diamond f{sample_fx8(px - (x_major ? 0 : k)), sample_fx8(py - (x_major ? k : 0))};
    if (f.meets(a, b) && !f.contains(b)) return true;
  }
  return false;
}

bool covers(const SnappedPoint& p, int px, int py) {
  if (p.round && p.size_fx8 >= 384) {
    const std::int64_t dx = 2 * (sample_fx8(px) - p.v.x_fx8);
    const std::int64_t dy = 2 * (sample_fx8(py) - p.v.y_fx8);
    const std::int64_t beyond = dx * dx + dy * dy - p.size_fx8 * p.size_fx8;
    return beyond < 0 || (beyond == 0 && (dx < 0 || (dx == 0 && dy < 0)));
  }
  // |sample − centre| < size / 2, doubled.
  const auto within = [&](std::int64_t sample, const Perturbed& centre) {
    const Perturbed twice = (Perturbed(sample) - centre) * Perturbed(2);
    return (twice - Perturbed(p.size_fx8)).sign() < 0 && (twice + Perturbed(p.size_fx8)).sign() > 0;
  };
  return within(sample_fx8(px), Perturbed(p.v.x_fx8, -1, 0)) &&
         within(sample_fx8(py), Perturbed(p.v.y_fx8, 0, -1));
}

float depth_at(const SnappedTriangle& t, int px, int py) {
  return depth_at_sample(t, sample_fx8(px), sample_fx8(py));
}

float depth_at_sample(const SnappedTriangle& t, std::int64_t x_fx8, std::int64_t y_fx8) {
  return depth_at(plane_of(t), x_fx8, y_fx8);
}

float depth_at(const SnappedPrimitive& p, int px, int py) {
  Plane plane = std::visit([](const auto& shape) { return plane_of(shape); }, p.shape);
  const double steepest = std::max(std::abs(plane.zx), std::abs(plane.zy));
  plane.z0 =
      static_cast<float>(double{plane.z0} + double{p.bias} + double{p.bias_slope} * steepest);
  return depth_at(plane, sample_fx8(px), sample_fx8(py));
}

namespace {

/// The vertices of a primitive and how far it reaches beyond them, in px.
struct Reach {
  std::span<const SnappedVertex> vertices;
  int margin;
};
Reach reach(const SnappedTriangle& t) {
  return {t.v, 2};
}
Reach reach(const SnappedLine& l) {
  return {l.v, 2 + l.width};
}
Reach reach(const SnappedPoint& p) {
  return {{&p.v, 1}, 2 + static_cast<int>(p.size_fx8 / 256)};
}

}  // namespace

OracleImage brute_force(int width, int height, std::span<const SnappedPrimitive> primitives) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<std::uint64_t> keys(pixels, 0);
  OracleImage image{width, height, {}, {}, std::vector<std::uint32_t>(pixels, 0)};
  for (const SnappedPrimitive& p : primitives)
    std::visit(
        [&](const auto& shape) {
          const auto [vertices, margin] = reach(shape);
          require_guard_band(vertices);
          std::int64_t x0 = kGuardMax, x1 = kGuardMin, y0 = kGuardMax, y1 = kGuardMin;
          for (const SnappedVertex& v : vertices) {
            x0 = std::min(x0, v.x_fx8);
            x1 = std::max(x1, v.x_fx8);
            y0 = std::min(y0, v.y_fx8);
            y1 = std::max(y1, v.y_fx8);
          }
          const auto first = [m = margin](std::int64_t fx8) {
            return static_cast<int>(std::max<std::int64_t>(fx8 / 256 - m, 0));
          };
          const auto last = [m = margin](std::int64_t fx8, int size) {
            return static_cast<int>(std::min<std::int64_t>(fx8 / 256 + m, size - 1));
          };
          for (int y = first(y0); y <= last(y1, height); ++y)
            for (int x = first(x0); x <= last(x1, width); ++x) {
              if (!covers(shape, x, y)) continue;
              const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x);
              ++image.overdraw[i];
              keys[i] = std::max(keys[i], visibility_key(depth_at(p, x, y), shape.id));
            }
        },
        p.shape);
  image.ids.resize(pixels);
  image.depth.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint64_t low = keys[i] & ((std::uint64_t{1} << 33) - 1);
    image.ids[i] =
        keys[i] == 0 ? -1 : static_cast<std::int64_t>((std::uint64_t{1} << 33) - 1 - low);
    image.depth[i] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[i] >> 33));
  }
  return image;
}

OracleImage brute_force(int width, int height, std::span<const SnappedTriangle> triangles,
                        Keep keep) {
  std::vector<SnappedPrimitive> kept;
  for (const SnappedTriangle& t : triangles) {
    const std::int64_t area = twice_area(t);
    const bool front = area < 0;  // counter-clockwise on the screen
    if (area == 0 || (keep == Keep::front && !front) || (keep == Keep::back && front)) continue;
    kept.push_back({t, 0, 0});
  }
  return brute_force(width, height, kept);
}

}  // namespace rastrum::test
