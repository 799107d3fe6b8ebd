// SPDX-License-Identifier: BSD-3-Clause
// Shader::wireframe: lines about a pixel wide along the edges of triangles, inside of them, drawn
// by the distance to the nearest edge on the screen.
//
// A distance is |r + p (x − x0) + q (y − y0)| in float64, of planes that are scaled to px once a
// triangle, in the scalar form and in lanes (wire-inl.hpp) by the same operations, so the bits are
// the same.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/program.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/shade/lit.hpp>

namespace rastrum::raster {

/// Farther than any edge in a picture, px: where there is none.
inline constexpr double kNoEdge = 1e9;

/// How much of a line covers the fragment, in [0, 1].
[[nodiscard]] float wire_share(const LocatedFragment& f);

/// Colours of one triangle that those at its pixels are made from: base · Σ corner · weight.
struct WireColors {
  Vec3 base;
  bool interpolates = false;  ///< else the colour is `base`
  Vec3 corner[3];
};
/// Finds those of a triangle of `draw`; `vertex`: among those of its mesh.
void fetch_wire_colors(const LitScene& scene, const Draw& draw, Draw::OfCopy triangle,
                       const std::uint32_t (&vertex)[3], WireColors& out);

/// The base colour at a fragment.
[[nodiscard]] Vec3 wire_base(const LitScene& scene, const FrameGeometry& frame, const Fragment& f);

}  // namespace rastrum::raster
