// SPDX-License-Identifier: BSD-3-Clause
// Shader::wireframe: lines about a pixel wide inside triangles along their edges, drawn by the
// distance to the nearest edge on the screen.
//
// A distance is |r + p (x − x0) + q (y − y0)| in float64, with planes scaled to px once a triangle.
// The scalar form and lanes (wire-inl.hpp) have the same operations and bits.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/program.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/shade/lit.hpp>

namespace rastrum::raster {

/// Stands for "no edge": farther than any in a picture, px.
inline constexpr double kNoEdge = 1e9;

/// The part of the fragment that a line covers, in [0, 1].
[[nodiscard]] float wire_share(const LocatedFragment& f);

/// The colours of a triangle: base · Σ corner · weight.
struct WireColors {
  Vec3 base;
  bool interpolates = false;  ///< else the colour is `base`
  Vec3 corner[3];
};
/// `vertex`: numbers within the mesh.
void fetch_wire_colors(const LitScene& scene, const Draw& draw, Draw::OfCopy triangle,
                       const std::uint32_t (&vertex)[3], WireColors& out);

[[nodiscard]] Vec3 wire_base(const LitScene& scene, const FrameGeometry& frame, const Fragment& f);

}  // namespace rastrum::raster
