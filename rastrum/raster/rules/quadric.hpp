// SPDX-License-Identifier: BSD-3-Clause
// A quadric on the screen: what setup (make_quadric.hpp) finds once a frame for a sphere, cone,
// tube or disc, and what its pieces refer to.
//
// Sigg, Weyrich, Botsch and Gross, "GPU-based ray-casting of quadratic surfaces" (2006). With M the
// matrix to clip space, a quadric Q is M⁻ᵀ Q M⁻¹ there. The ray of pixel (x, y) meets it at the
// depths d with (x, y, d, 1) M⁻ᵀ Q M⁻¹ (x, y, d, 1)ᵀ = 0, that is A d² + 2 B d + C = 0, with A
// constant, B linear and D = B² − A C quadratic in x and y. Deviations: all is float64 and relative
// to a pixel and a depth of the primitive, so that nothing cancels far from the origin. Flat ends
// and hulls of tubes are intervals of depth along the ray.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <rastrum/config.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// Below, (dx, dy) is a sample's offset from (Piece::x[0], y[0]), px, and e = d − Quadric::depth0.

/// e ≥ or ≤ at + x · dx + y · dy.
struct DepthLimit {
  double at, x, y;
  bool is_least;
};

/// The inside of a quadric, A e² + 2 B e + C ≤ 0, between limits.
struct QuadricPart {
  double b, bx, by;                 ///< B
  double d, dx, dy, dxx, dxy, dyy;  ///< D = B² − A C
  double inverse_a;                 ///< finite and not 0; negative: the eye is inside
  DepthLimit limits[3];
  std::uint32_t limit_count;
};

/// The convex hull of 1 to 3 parts.
struct Quadric {
  double depth0;
  double nearest;         ///< the near plane's e
  float lowest, highest;  ///< bounds of the primitive's depths
  std::uint32_t part_count;
  bool is_open;   ///< the quadric itself between the limits, not its inside
  bool is_plain;  ///< one part, no limits, and no check of the near plane
  QuadricPart part[3];

  /// Nothing reads the bytes behind these.
  [[nodiscard]] RASTRUM_HD std::size_t bytes() const {
    return is_plain ? offsetof(Quadric, part) + offsetof(QuadricPart, limits)
                    : offsetof(Quadric, part) + part_count * sizeof(QuadricPart);
  }
};

/// A quadric has two pieces: the surface that faces the viewer and, with kFacesAway, the other one.
/// A piece keeps in x[0], y[0] the pixel that the quadric is relative to, in the others two corners
/// of its box, n.8, and a pointer to the quadric.
RASTRUM_HD inline void set_quadric(Piece& p, const Quadric* quadric) {
  const auto halves =
      std::bit_cast<std::array<float, 2>>(std::uint64_t{reinterpret_cast<std::uintptr_t>(quadric)});
  p.z0 = 0;
  p.zx = halves[0];
  p.zy = halves[1];
}
RASTRUM_HD inline const Quadric& quadric_of(const Piece& p) {
  const auto address = std::bit_cast<std::uint64_t>(std::array<float, 2>{p.zx, p.zy});
  return *reinterpret_cast<const Quadric*>(static_cast<std::uintptr_t>(address));
}

namespace scalar_wide {

using W = double;
using WideMask = bool;
using WideVec = Vec3d;

RASTRUM_HD inline W wide(W v) {
  return v;
}
RASTRUM_HD inline WideVec wide(const WideVec& v) {
  return v;
}
RASTRUM_HD inline W square_root(W v) {
  return std::sqrt(v);
}
RASTRUM_HD inline W absolute(W v) {
  return std::abs(v);
}
RASTRUM_HD inline W floor_of(W v) {
  return std::floor(v);
}
RASTRUM_HD inline W lesser(W a, W b) {
  return a < b ? a : b;
}
RASTRUM_HD inline W greater(W a, W b) {
  return a > b ? a : b;
}
RASTRUM_HD inline bool below(W a, W b) {
  return a < b;
}
RASTRUM_HD inline bool at_most(W a, W b) {
  return a <= b;
}
RASTRUM_HD inline bool both(bool a, bool b) {
  return a && b;
}
RASTRUM_HD inline bool either(bool a, bool b) {
  return a || b;
}
RASTRUM_HD inline bool opposite(bool a) {
  return !a;
}
RASTRUM_HD inline bool is_any(bool a) {
  return a;
}
RASTRUM_HD inline W choose(bool mask, W yes, W no) {
  return mask ? yes : no;
}

#define RASTRUM_LANES RASTRUM_HD inline
#include <rastrum/raster/rules/quadric_depth.inl>
#undef RASTRUM_LANES

}  // namespace scalar_wide

/// Clamped as in depth_at.
RASTRUM_HD inline float quadric_depth(const Quadric& q, double e) {
  const auto depth = static_cast<float>(q.depth0 + e);
  const float at_least_0 = depth > 0 ? depth : 0.0F;
  return at_least_0 < 1 ? at_least_0 : 1.0F;
}

struct QuadricSample {
  bool is_covered;
  float depth;  ///< in [+0, 1]; 0 where it is not covered
};

RASTRUM_HD inline QuadricSample sample_quadric(const Piece& p, int x, int y) {
  constexpr double kPxPerSubpixel = 1.0 / kSubpixels;
  const Quadric& q = quadric_of(p);
  const double dx = (x + 0.5) - p.x[0] * kPxPerSubpixel;
  const double dy = (y + 0.5) - p.y[0] * kPxPerSubpixel;
  const scalar_wide::Surface s =
      scalar_wide::surface_at(q, scalar_wide::QuadricRow(q, dy), (p.flags & kFacesAway) != 0, dx);
  return {s.covered, s.covered ? quadric_depth(q, s.e) : 0.0F};
}

}  // namespace rastrum::raster
