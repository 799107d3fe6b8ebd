// SPDX-License-Identifier: BSD-3-Clause
// The brute-force oracle: all pixels × all triangles, in exact integers. It shares no code with the
// library (it includes none of it), so that an agreement of the two is evidence. Plain on purpose.
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

/// Either a whole triangle or one piece of a clipped one; the pieces share the triangle's id.
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

/// A primitive and what is added to its depth: constant + slope · its steepest change per px.
struct SnappedPrimitive {
  std::variant<SnappedTriangle, SnappedLine, SnappedPoint> shape;
  float bias = 0, bias_slope = 0;
};

enum class Keep { all, front, back };

/// W × H, row 0 at the top; `ids` −1 and `depth` 0 where nothing is.
struct OracleImage {
  int width = 0, height = 0;
  std::vector<std::int64_t> ids;
  std::vector<float> depth;
  std::vector<std::uint32_t> overdraw;

  [[nodiscard]] std::uint64_t fragments() const;
  [[nodiscard]] std::uint64_t pixels_covered() const;
  /// The pixels that hold it.
  [[nodiscard]] std::uint64_t pixels_of(const SnappedPrimitive& p) const;
};

/// Twice the signed area in n.8 units, positive where the vertices turn clockwise on the screen.
[[nodiscard]] std::int64_t twice_area(const SnappedTriangle& t);

/// Whether the sample of pixel (px, py) belongs to `t`: exact, top-left rule.
[[nodiscard]] bool covers(const SnappedTriangle& t, int px, int py);

/// Whether the sample at (x, y), n.8 px, belongs to `t`: a pixel has one at its centre, or several.
[[nodiscard]] bool covers_sample(const SnappedTriangle& t, std::int64_t x_fx8, std::int64_t y_fx8);

/// The depth plane of `t` at the sample of pixel (px, py), by the rules of docs/coverage.md.
[[nodiscard]] float depth_at(const SnappedTriangle& t, int px, int py);
[[nodiscard]] float depth_at_sample(const SnappedTriangle& t, std::int64_t x_fx8,
                                    std::int64_t y_fx8);

/// bits(depth) << 33 | (2³³ − 1 − id): the larger one is in front.
[[nodiscard]] std::uint64_t visibility_key(float depth, std::int64_t id);

/// Whether a line produces the fragment of pixel (px, py): OpenGL's diamond-exit rule (4.6, 14.5.1)
/// as it is written, with y down and both ends moved by −(ε, ε²) for an infinitesimal ε. A wide
/// line is moved by −(width − 1) / 2 across and each of its pixels repeated.
[[nodiscard]] bool covers(const SnappedLine& l, int px, int py);
/// Whether the sample of pixel (px, py) lies in the square, moved likewise, or, round and of 1.5 px
/// or more, in the disc with the left half of its rim and the top.
[[nodiscard]] bool covers(const SnappedPoint& p, int px, int py);

[[nodiscard]] float depth_at(const SnappedPrimitive& p, int px, int py);

/// Cost: O(W · H · primitives) but for a margin about each. Triangles of any facing.
[[nodiscard]] OracleImage brute_force(int width, int height,
                                      std::span<const SnappedPrimitive> primitives);

/// Cost: O(W · H · triangles); only rows and columns that a bounding box misses by more than a
/// pixel are left out. Coordinates must lie in the guard band [−2¹⁵, 2¹⁶] px (checked).
[[nodiscard]] OracleImage brute_force(int width, int height,
                                      std::span<const SnappedTriangle> triangles,
                                      Keep keep = Keep::all);

}  // namespace rastrum::test
