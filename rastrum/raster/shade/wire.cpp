// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/wire.hpp>

#include <algorithm>

#include <rastrum/raster/shade/lit_triangle.hpp>

namespace rastrum::raster {

float wire_share(const LocatedFragment& f) {
  const WeightPlanes& w = *f.planes;
  const double dx = f.x + 0.5 + static_cast<double>(f.from_centre.x) - w.x0;
  const double dy = f.y + 0.5 + static_cast<double>(f.from_centre.y) - w.y0;
  double nearest = kNoEdge;
  for (int i = 0; i < 3; ++i) {
    const double square = w.p[i] * w.p[i] + w.q[i] * w.q[i];
    const double scale = 1 / std::sqrt(square);
    const double d = std::abs(w.r[i] * scale + w.p[i] * scale * dx + w.q[i] * scale * dy);
    // An edge at infinity has no slope and no distance.
    if (square > 0 && d < nearest) nearest = d;
  }
  return static_cast<float>(std::clamp(1.0 - nearest, 0.0, 1.0));
}

void fetch_wire_colors(const LitScene& scene, const Draw& draw, Draw::OfCopy triangle,
                       const std::uint32_t (&vertex)[3], WireColors& out) {
  const auto fetch = [&](const LitDraw& lit) {
    const TrianglePlace place = lit.mesh->place(triangle.primitive);
    out.base = scene.view().base_color(lit, place.face);
    out.interpolates = !lit.colors.empty();
    if (!out.interpolates) return;
    Vec4 corner[3];
    display_colors(lit, place, vertex, corner);
    for (int c = 0; c < 3; ++c) out.corner[c] = {corner[c].x, corner[c].y, corner[c].z};
  };
  const LitDraw& shared = scene.draws[draw.number];
  if (draw.is_copied())
    fetch(shared.of(shared.copies[triangle.copy]));
  else
    fetch(shared);
}

Vec3 wire_base(const LitScene& scene, const FrameGeometry& frame, const Fragment& f) {
  const Draw& draw = frame.draws[f.draw];
  WireColors colors;
  fetch_wire_colors(scene, draw, draw.of_copy(f.id - draw.first_id), f.vertex, colors);
  if (!colors.interpolates) return colors.base;
  Vec3 sum;
  for (std::size_t c = 0; c < 3; ++c)
    sum = sum + colors.corner[c] * static_cast<float>(f.weights.b[c]);
  return {colors.base.x * sum.x, colors.base.y * sum.y, colors.base.z * sum.z};
}

}  // namespace rastrum::raster
