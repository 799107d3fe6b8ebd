// SPDX-License-Identifier: BSD-3-Clause
// An instance's scalars at a place of its surface, and their colours (docs/scalar_rules.md):
// interpolated, then mapped, in float64, in the order of surface_scalars.cpp.
#pragma once

#include <rastrum/color_map.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// The scalars of one instance, which must outlive this. Empty: there are none.
class SurfaceScalars {
 public:
  SurfaceScalars() = default;
  /// `colors`: null if the scalars colour nothing.
  SurfaceScalars(const InstanceView& instance, const ScalarColors* colors);

  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// Null: they colour nothing.
  [[nodiscard]] const ScalarColors* colors() const { return colors_; }

  /// At the corners of a fragment's primitive, as many as the topology has.
  void at_corners(const Fragment& f, Topology topology, double (&out)[3]) const;
  /// At a fragment of a mesh, points or lines.
  [[nodiscard]] double at(const Fragment& f, Topology topology) const;
  /// At the two ends of a quadric's axis, and between them.
  void at_ends(const AxisEnds& ends, double (&out)[2]) const;
  [[nodiscard]] static double between(const double (&ends)[2], double along);

  /// A fragment's base colour: straight alpha; a display value or linear light. Requires colors(),
  /// as do the next.
  [[nodiscard]] Vec4 color(const Fragment& f, Topology topology, bool linear) const;
  [[nodiscard]] Vec4 color(const double (&corner)[3], const Weights& weights, Topology topology,
                           bool linear) const;
  /// Draws isolines over the mapped colour of a fragment's number.
  [[nodiscard]] Vec4 with_isolines(Vec4 mapped, double value, const double (&corner)[3],
                                   const Weights& weights, Topology topology) const;
  /// Along a quadric's axis, where `along` changes by `along_per_px` a pixel.
  [[nodiscard]] Vec4 color(const double (&ends)[2], double along, double along_per_px,
                           bool linear) const;

 private:
  MeshScalarsView values_;
  const MeshView* mesh_ = nullptr;  ///< null: not a mesh
  const ScalarColors* colors_ = nullptr;
};

}  // namespace rastrum::raster
