// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/surface_scalars.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/scene/scalars.hpp>

namespace rastrum::raster {
namespace {

/// Σ bᵢ vᵢ, left to right, clamped to the numbers' range: what is equal at all corners is equal
/// everywhere, and rounding does not leave the corners' range.
double weighted(const double* b, const double* v, int n) {
  double sum = v[0] * b[0], low = v[0], high = v[0];
  bool nan = std::isnan(v[0]);
  for (int i = 1; i < n; ++i) {
    sum = sum + v[i] * b[i];
    low = std::min(low, v[i]);
    high = std::max(high, v[i]);
    nan |= std::isnan(v[i]);
  }
  if (nan) return sum;
  if (low == high) return low;
  return sum < low ? low : sum > high ? high : sum;
}

}  // namespace

SurfaceScalars::SurfaceScalars(const InstanceView& instance, const ScalarColors* colors)
    : values_(scalars_of(instance)),
      mesh_(instance.mesh()),
      colors_(values_.empty() ? nullptr : colors) {}

void SurfaceScalars::at_corners(const Fragment& f, Topology topology, double (&out)[3]) const {
  const int n = static_cast<int>(topology);
  if (values_.per == Per::mesh) {
    std::fill_n(out, n, values_.values[0]);
  } else if (values_.per == Per::vertex) {
    for (int c = 0; c < n; ++c) out[c] = values_.values[f.vertex[c]];
  } else {
    const TrianglePlace place = mesh_->place(f.triangle);
    for (int c = 0; c < n; ++c)
      out[c] = values_.values[values_.per == Per::face ? place.face : place.corner[c]];
  }
}

double SurfaceScalars::at(const Fragment& f, Topology topology) const {
  double corner[3];
  at_corners(f, topology, corner);
  return weighted(f.weights.b, corner, static_cast<int>(topology));
}

void SurfaceScalars::at_ends(const AxisEnds& ends, double (&out)[2]) const {
  const bool one = values_.per == Per::mesh;
  out[0] = values_.values[one ? 0 : ends.first];
  out[1] = values_.values[one ? 0 : ends.second];
}

double SurfaceScalars::between(const double (&ends)[2], double along) {
  const double weights[2] = {1 - along, along};
  return weighted(weights, ends, 2);
}

Vec4 SurfaceScalars::color(const Fragment& f, Topology topology, bool linear) const {
  double corner[3];
  at_corners(f, topology, corner);
  return color(corner, f.weights, topology, linear);
}

Vec4 SurfaceScalars::color(const double (&corner)[3], const Weights& weights, Topology topology,
                           bool linear) const {
  const double value = weighted(weights.b, corner, static_cast<int>(topology));
  return converted(with_isolines((*colors_)(value), value, corner, weights, topology),
                   ColorSpace::display, linear ? ColorSpace::linear : ColorSpace::display);
}

Vec4 SurfaceScalars::with_isolines(Vec4 mapped, double value, const double (&corner)[3],
                                   const Weights& weights, Topology topology) const {
  if (!colors_->has_isolines()) return mapped;
  double dx = 0, dy = 0;
  for (int c = 0; c < static_cast<int>(topology); ++c) {
    dx = dx + corner[c] * weights.db_dx[c];
    dy = dy + corner[c] * weights.db_dy[c];
  }
  return colors_->with_isolines(mapped, value, std::sqrt(dx * dx + dy * dy));
}

Vec4 SurfaceScalars::color(const double (&ends)[2], double along, double along_per_px,
                           bool linear) const {
  const double value = between(ends, along);
  Vec4 c = (*colors_)(value);
  if (colors_->has_isolines())
    c = colors_->with_isolines(c, value, std::abs(ends[1] - ends[0]) * along_per_px);
  return converted(c, ColorSpace::display, linear ? ColorSpace::linear : ColorSpace::display);
}

}  // namespace rastrum::raster
