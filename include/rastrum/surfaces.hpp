// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that are no triangles: spheres, cylinders and cones, tubes, discs. They are drawn
// exactly, as quadrics (docs/primitives.md), not as meshes of them. A view has the caller's arrays,
// of any types and strides (array.hpp); nothing is copied, so they must outlive the render. All
// have in common: coordinates and radii are in object space; any affine object_to_world makes a
// sphere the exact ellipsoid. Positions and normals in float64 are taken as they are, radii and
// colours are rounded to float32. A radius of 0 draws nothing. A primitive with a radius that is
// negative, or with a number that is not finite, is dropped and counted. If `radii` is empty, all
// have `radius`. `colors` are display values with straight alpha; if they are empty, the material's
// or the plain colour stands. The render refuses arrays that are too short, indices out of range
// and offsets that do not rise, and names instance, array and place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <rastrum/array.hpp>
#include <rastrum/scalars.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// A primitive is a sphere.
struct SpheresView {
  ArrayView<Vec3> centers{};
  ArrayView<float> radii{};  ///< one a sphere
  float radius = 1;
  ArrayView<Vec4> colors{};    ///< one a sphere
  std::uint32_t material = 0;  ///< index into SceneView::materials
  ScalarView scalars{};        ///< one a sphere

  [[nodiscard]] std::size_t size() const { return centers.size(); }
};

/// A primitive is a cylinder between two positions, or a cone if their radii differ. One of length
/// 0 draws nothing.
struct CylindersView {
  ArrayView<Vec3> positions{};
  IndexView indices{};       ///< two a primitive; empty: positions in order
  ArrayView<float> radii{};  ///< one a position
  float radius = 1;
  ArrayView<Vec4> colors{};  ///< one a position, linear along the axis
  bool caps = true;          ///< closed by flat discs; else open, and seen from inside, too
  std::uint32_t material = 0;
  ScalarView scalars{};  ///< one a position, linear along the axis

  [[nodiscard]] std::size_t size() const {
    return (indices.empty() ? positions.size() : indices.size()) / 2;
  }
  /// The position of end `i`, 0 or 1, of a primitive.
  [[nodiscard]] std::size_t end(std::uint64_t primitive, int i) const {
    const std::size_t k = static_cast<std::size_t>(primitive) * 2 + static_cast<std::size_t>(i);
    return indices.empty() ? k : indices[k];
  }
};

/// Polylines with round joints and ends. A primitive is a segment: the convex hull of the spheres
/// about its two positions, so that neighbours share a sphere.
struct TubesView {
  ArrayView<Vec3> positions{};
  /// Polyline i has the positions [offsets[i], offsets[i + 1]): rising, one more than polylines.
  /// Empty: one polyline.
  IndexView offsets{};
  ArrayView<float> radii{};  ///< one a position
  float radius = 1;
  ArrayView<Vec4> colors{};  ///< one a position, linear along the axis
  std::uint32_t material = 0;
  ScalarView scalars{};  ///< one a position, linear along the axis

  /// The number of segments. O(1).
  [[nodiscard]] std::size_t size() const;
  /// The position at which a segment begins; it ends at the next. O(log polylines).
  [[nodiscard]] std::size_t begin(std::uint64_t segment) const;
};

/// A primitive is a flat disc. It has two sides; its front is where its normal points to.
struct DiscsView {
  ArrayView<Vec3> centers{};
  ArrayView<Vec3> normals{};  ///< one a disc, need not be of unit length; 0 draws nothing
  ArrayView<float> radii{};   ///< one a disc
  float radius = 1;
  ArrayView<Vec4> colors{};  ///< one a disc
  std::uint32_t material = 0;
  ScalarView scalars{};  ///< one a disc

  [[nodiscard]] std::size_t size() const { return centers.size(); }
};

// Surfaces that own their arrays, as readers and procedural shapes return them. The views say what
// each array is.

struct Spheres {
  std::string name{};
  std::vector<Vec3> centers{};
  std::vector<float> radii{};
  float radius = 1;
  std::vector<Vec4> colors{};
  std::uint32_t material = 0;
  std::vector<NamedScalars> scalars{};

  [[nodiscard]] SpheresView view() const;
};

struct Cylinders {
  std::string name{};
  std::vector<Vec3> positions{};
  std::vector<std::uint32_t> indices{};
  std::vector<float> radii{};
  float radius = 1;
  std::vector<Vec4> colors{};
  bool caps = true;
  std::uint32_t material = 0;
  std::vector<NamedScalars> scalars{};

  [[nodiscard]] CylindersView view() const;
};

struct Tubes {
  std::string name{};
  std::vector<Vec3> positions{};
  std::vector<std::uint32_t> offsets{};
  std::vector<float> radii{};
  float radius = 1;
  std::vector<Vec4> colors{};
  std::uint32_t material = 0;
  std::vector<NamedScalars> scalars{};

  [[nodiscard]] TubesView view() const;
};

struct Discs {
  std::string name{};
  std::vector<Vec3> centers{};
  std::vector<Vec3> normals{};
  std::vector<float> radii{};
  float radius = 1;
  std::vector<Vec4> colors{};
  std::uint32_t material = 0;
  std::vector<NamedScalars> scalars{};

  [[nodiscard]] DiscsView view() const;
};

}  // namespace rastrum
