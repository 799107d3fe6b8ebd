// SPDX-License-Identifier: BSD-3-Clause
// The brute-force oracle: all pixels × all triangles, in exact integers. It includes nothing of the
// library, so agreement is evidence. Deliberately plain.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace rastrum::test {

/// A vertex after projection and snapping: pixels in n.8 fixed point, y down, and its depth.
struct SnappedVertex {
  std::int64_t x_fx8 = 0, y_fx8 = 0;
  float depth = 0;
};

/// A whole triangle or a piece of a clipped one. Pieces share the triangle's id.
struct SnappedTriangle {
  SnappedVertex v[3];
  std::int64_t id = 0;
};

/// Width in whole px.
struct SnappedLine {
  SnappedVertex v[2];
  int width = 1;
  std::int64_t id = 0;
};

struct SnappedPoint {
  SnappedVertex v;
  std::int64_t size_fx8 = 256;
  std::int64_t id = 0;
  bool round = false;
};

/// A primitive and its depth offset: constant + slope · its steepest depth change per px.
struct SnappedPrimitive {
  std::variant<SnappedTriangle, SnappedLine, SnappedPoint> shape;
  float bias = 0, bias_slope = 0;
};

enum class Keep { all, front, back };

/// W × H, row 0 at the top; `ids` −1 and `depth` 0 where nothing is drawn.
struct OracleImage {
  int width = 0, height = 0;
  std::vector<std::int64_t> ids;
  std::vector<float> depth;
  std::vector<std::uint32_t> overdraw;

  [[nodiscard]] std::uint64_t fragments() const;
  [[nodiscard]] std::uint64_t pixels_covered() const;
  /// The number of pixels that show it.
  [[nodiscard]] std::uint64_t pixels_of(const SnappedPrimitive& p) const;
};

/// Twice the signed area in n.8 units, positive where the vertices turn clockwise on the screen.
[[nodiscard]] std::int64_t twice_area(const SnappedTriangle& t);

/// Whether the sample of pixel (px, py) belongs to `t`: exact, top-left rule.
[[nodiscard]] bool covers(const SnappedTriangle& t, int px, int py);

/// Whether the sample at (x, y), n.8 px, belongs to `t`. A pixel has one sample at its centre, or
/// several.
[[nodiscard]] bool covers_sample(const SnappedTriangle& t, std::int64_t x_fx8, std::int64_t y_fx8);

/// The depth plane of `t` at the sample of pixel (px, py), by the rules of docs/coverage.md.
[[nodiscard]] float depth_at(const SnappedTriangle& t, int px, int py);
[[nodiscard]] float depth_at_sample(const SnappedTriangle& t, std::int64_t x_fx8,
                                    std::int64_t y_fx8);

/// bits(depth) << 33 | (2³³ − 1 − id); the larger key is in front.
[[nodiscard]] std::uint64_t visibility_key(float depth, std::int64_t id);

/// Whether a line covers pixel (px, py): OpenGL's diamond-exit rule (4.6, 14.5.1) with y down and
/// both ends moved by −(ε, ε²) for an infinitesimal ε. A wide line is moved by −(width − 1) / 2
/// across, and each of its pixels is repeated.
[[nodiscard]] bool covers(const SnappedLine& l, int px, int py);
/// Whether the sample of pixel (px, py) lies in the point's square, moved likewise. For round
/// points of at least 1.5 px: in the disc with the left half of its rim and the top.
[[nodiscard]] bool covers(const SnappedPoint& p, int px, int py);

[[nodiscard]] float depth_at(const SnappedPrimitive& p, int px, int py);

/// Cost: O(W · H · primitives), limited to a margin around each. Triangles of any facing.
[[nodiscard]] OracleImage brute_force(int width, int height,
                                      std::span<const SnappedPrimitive> primitives);

/// Cost: O(W · H · triangles), without rows and columns more than a pixel outside of a bounding
/// box. Coordinates must lie in the guard band [−2¹⁵, 2¹⁶] px (checked).
[[nodiscard]] OracleImage brute_force(int width, int height,
                                      std::span<const SnappedTriangle> triangles,
                                      Keep keep = Keep::all);

}  // namespace rastrum::test
