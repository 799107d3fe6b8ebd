// SPDX-License-Identifier: BSD-3-Clause
// The numbers of an instance at a place of its surface, and the colours that they become
// (docs/scalar_rules.md): interpolated first and mapped then, in float64, in the order
// that is written in surface_scalars.cpp.
#pragma once

#include <rastrum/color_map.hpp>
#include <rastrum/program.hpp>
#include <rastrum/raster/rules/quadrics.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// The numbers of one instance, which must outlive this. Empty: an instance without numbers, or
/// none.
class SurfaceScalars {
 public:
  SurfaceScalars() = default;
  /// `colors`: null where its numbers colour nothing.
  SurfaceScalars(const InstanceView& instance, const ScalarColors* colors);

  /// Whether there are numbers.
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// Null where they colour nothing.
  [[nodiscard]] const ScalarColors* colors() const { return colors_; }

  /// The numbers at the corners of the primitive of a fragment, as many as the topology has.
  void at_corners(const Fragment& f, Topology topology, double (&out)[3]) const;
  /// The number at a fragment of a mesh, of points or of lines.
  [[nodiscard]] double at(const Fragment& f, Topology topology) const;
  /// The numbers at the two ends of a quadric's axis, and one between them.
  void at_ends(const AxisEnds& ends, double (&out)[2]) const;
  [[nodiscard]] static double between(const double (&ends)[2], double along);

  /// The base colour of a fragment: straight alpha; a display value or linear light. Requires
  /// colors(), as do the next.
  [[nodiscard]] Vec4 color(const Fragment& f, Topology topology, bool linear) const;
  [[nodiscard]] Vec4 color(const double (&corner)[3], const Weights& weights, Topology topology,
                           bool linear) const;
  /// Draws the isolines of a fragment over the mapped colour of its number.
  [[nodiscard]] Vec4 with_isolines(Vec4 mapped, double value, const double (&corner)[3],
                                   const Weights& weights, Topology topology) const;
  /// The same along a quadric's axis, where `along` changes by `along_per_px` from pixel to pixel.
  [[nodiscard]] Vec4 color(const double (&ends)[2], double along, double along_per_px,
                           bool linear) const;

 private:
  MeshScalarsView values_;
  const MeshView* mesh_ = nullptr;  ///< null: it is none
  const ScalarColors* colors_ = nullptr;
};

}  // namespace rastrum::raster
