// SPDX-License-Identifier: BSD-3-Clause
// Facts that a frame may find about a cluster before it sets up a triangle: all triangles are
// outside of the picture, all face away, or where on the screen and how near a sample can be.
//
// Exactness. A cluster may be left out only where setting it up would change no key. Setup
// transforms in float32 (float64 for wide positions), divides, snaps to 1/256 px and evaluates
// planes in float32. The bounds here are in float64 over the box of the object-space vertices, with
// margins for all of that. u = 2⁻²⁴ is float32's rounding.
//
// 1. Clip coordinates. A row is ((m₀x + m₁y) + m₂z) + m₃ with four roundings of products and three
//    of sums. The float32 value differs from the exact one of the rounded matrix by less than 4u S,
//    S = Σ |mᵢ| max|pᵢ| + |m₃|, and from that of the unrounded one by u S more. δ = 2⁻²⁰ S = 16u S
//    bounds both, with the roundings of float64 here and a tiny term for subnormals.
// 2. Outside. All corners of the box have x + w ≤ −(δx + δw) − 16u S, so all vertices have x/w ≤
//    −(1 + 16u) in float32, or w ≤ 0. A projected one has px = fl(fl(fl(x · fl(1/w)) · hw) + hw)
//    ≤ 0: three roundings of u each do not undo 16u. It snaps to at most 0. No sample of the
//    picture lies left of 0, and what touches 0 from the left does not cover there (top-left).
//    Where a vertex needs the clipper, its float64 corners lie between vertices for which the same
//    holds, with 2⁻⁵³ for u. The other three sides likewise. Behind the near plane (z − w ≥ …) and
//    for w ≤ −δw the clipper leaves nothing. Nothing is cut at the far plane.
// 3. Whole. The other tests want clusters without a vertex that needs the clipper: w > 0, z ≤ w and
//    the guard band, with the same margins.
// 4. Places. px of a box are those of its corners (x/w is a projective map, w > 0). A vertex is off
//    by at most ε = 1/512 (snapping) + hw ((δx + X δw)/w + 2⁻²¹(X + 1)), X = max |x/w|.
// 5. Away. D = det(x, y, w of the corners) = n · (E − e p₀), n the cross product of the triangle's
//    edges, (E, e) the null vector of the matrix's rows x, y, w (the eye). In the cluster's cone
//    and ball D/|n| ≥ f = |v| cos(φ + α) − |e| r, v = E − e c. Twice the area on the screen is hw
//    hh D / (w₀w₁w₂) ≥ f |n| hw hh / w³max, |n| = L h (longest edge and least height). Snapping
//    moves corners by ε, and edges are at most Gx L and Gy L long there, G the largest change of px
//    with a step in object space. The area keeps its sign where f L h hw hh / w³ > 4 L (Gx εy +
//    Gy εx) + 8 εx εy. So tiny triangles, whose orientation snapping may turn, are not left out.
// 6. Depth. A covered sample lies in the snapped triangle, where the exact plane has at most the
//    greatest depth of its corners: Z + (δz + Z δw)/w + 2⁻²² Z. Setup's plane has slopes of at most
//    2 Δ E/|det| per 1/256 px (Δ: the difference of the corners' depths, E their distance in 1/256
//    px, |det| ≥ 1), rounded to float32. Their products with a distance in the triangle and two
//    sums are off by at most u (10 Δ Ex Ey + 2 Z), in px 0.04 Δ Ex Ey: 0.05 is taken. A sliver may
//    reach that; larger areas do better.
#pragma once

#include <cstdint>

#include <rastrum/frame.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/projection.hpp>
#include <rastrum/scene/mesh_clusters.hpp>

namespace rastrum::raster {

/// A box's place, as far as the flags say.
struct BoxPlace {
  bool outside = false;  ///< no triangle in it is drawn
  bool inside = false;   ///< none of it is outside or needs the clipper
  bool whole = false;    ///< no vertex in it needs the clipper; then:
  Rect pixels{};         ///< where a sample may be covered, not cut to the picture
  float highest = 0;     ///< no vertex is nearer, by float32's depth
  double w_min = 0, w_max = 0;
  double x_ndc = 0, y_ndc = 0, z_ndc = 0;        ///< the largest |x/w|, |y/w|, |z/w|
  double z_range = 0;                            ///< the largest difference of depths
  double x_error = 0, y_error = 0, z_error = 0;  ///< of a vertex, px, px, depth
};

/// One transform of a mesh to the screen.
class ClusterView {
 public:
  /// `to_clip`: as it transforms vertices: rounded to float32, unless they are wide. `faces`:
  /// faces_away and leans_away will be called; preparing them takes as long as a place.
  ClusterView(const Mat4d& to_clip, bool wide, Viewport viewport, bool faces = true);

  [[nodiscard]] BoxPlace place(Vec3 min, Vec3 max) const;
  /// Whether facing culls all its triangles. `at`: its box's place, whole.
  [[nodiscard]] bool faces_away(const MeshCluster& cluster, const BoxPlace& at, Cull cull) const;
  /// A hint: most of it seems to face away.
  [[nodiscard]] bool leans_away(const MeshCluster& cluster) const;
  /// No sample of its triangles is nearer. `at`: its box's place, whole.
  [[nodiscard]] float highest_sample(const MeshCluster& cluster, const BoxPlace& at) const;

 private:
  /// The largest change of (row `row`) / w with a step of length 1.
  [[nodiscard]] double steepest(int row, double ndc, const BoxPlace& at) const;

  Mat4d m_;
  Viewport viewport_;
  double rows_[4];  ///< lengths of the rows' first three elements
  Vec3d eye_{};     ///< (E, e) of the above, and error bounds
  double eye_w_ = 0, eye_error_ = 0, eye_w_error_ = 0;
};

}  // namespace rastrum::raster
