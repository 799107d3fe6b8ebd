// SPDX-License-Identifier: BSD-3-Clause
// Spheres, cylinders, cones, tubes and discs as the pipeline draws them: one shape each, in object
// space.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <rastrum/mat.hpp>
#include <rastrum/surfaces.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

enum class QuadricKind : std::uint8_t {
  sphere,
  cone,       ///< between two flat ends; a cylinder where the radii are equal
  open_cone,  ///< without the ends
  hull,       ///< of two spheres: a tube's segment
  disc,       ///< about p0; p1 is its unit normal
};

/// Whether p1 and r1 belong to a second end.
constexpr bool has_two_ends(QuadricKind kind) {
  return kind != QuadricKind::sphere && kind != QuadricKind::disc;
}

/// A shape whose numbers are all finite.
struct QuadricShape {
  QuadricKind kind = QuadricKind::sphere;
  Vec3d p0, p1;
  double r0 = 0, r1 = 0;
  double along = 0;  ///< of a sphere: the end of its primitive, 0 or 1
};

enum class ShapeFate : std::uint8_t {
  drawn,
  empty,   ///< nothing to draw: a radius or a length of 0
  dropped  ///< a number that is not finite, or a negative radius
};

using QuadricGeometry = std::variant<SpheresView, CylindersView, TubesView, DiscsView>;

/// Indices of positions, radii and colours; equal if there is one end. Offsets must be in range.
struct AxisEnds {
  std::size_t first, second;
};
[[nodiscard]] AxisEnds axis_ends(const QuadricGeometry& geometry, std::uint64_t i);
[[nodiscard]] const ArrayView<Vec3>& positions_of(const QuadricGeometry& geometry);

/// The primitives of a draw and their matrices. Must outlive the frame.
class QuadricStage {
 public:
  /// Where `object_to_clip` has no inverse nothing is drawn.
  QuadricStage(const QuadricGeometry& geometry, const Mat4d& object_to_clip);

  /// Simplifies: a hull in which one sphere holds the other becomes that sphere. Indices must be in
  /// range.
  [[nodiscard]] ShapeFate shape(std::uint64_t i, QuadricShape& out) const;
  /// Prefetches what shape() will read.
  void prefetch(std::uint64_t i) const;
  [[nodiscard]] const Mat4d& object_to_clip() const { return object_to_clip_; }
  [[nodiscard]] const Mat4d* clip_to_object() const { return inverse_ ? &*inverse_ : nullptr; }
  [[nodiscard]] const QuadricGeometry& geometry() const { return geometry_; }

 private:
  QuadricGeometry geometry_;
  Mat4d object_to_clip_;
  std::optional<Mat4d> inverse_;
};

}  // namespace rastrum::raster
