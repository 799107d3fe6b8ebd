// Surfaces that are no triangles: spheres, cylinders and cones, tubes, discs. They are drawn
// exactly, as quadrics (docs/primitives.md), not as meshes of them. Views over the caller's arrays;
// nothing is copied, so they must outlive the render.
//
// What is in common. Coordinates and radii are of object space; under any affine object_to_world a
// sphere is the ellipsoid that it becomes. A radius of 0 draws nothing. A primitive with a radius
// that is negative, or with a number that is not finite, is dropped and counted. `radii` empty:
// `radius` for all. `colors`: linear, straight alpha; empty: the plain colour, or the material's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/vec.hpp>

namespace rastrum {

/// A primitive is a sphere.
struct SpheresView {
  std::span<const Vec3> centers{};
  std::span<const float> radii{};  ///< one a sphere
  float radius = 1;
  std::span<const Vec4> colors{};  ///< one a sphere
  std::uint32_t material = 0;      ///< index into SceneView::materials

  [[nodiscard]] std::size_t size() const { return centers.size(); }
};

/// A primitive is a cylinder between two positions, a cone where their radii differ. Of length 0 it
/// draws nothing.
struct CylindersView {
  std::span<const Vec3> positions{};
  std::span<const std::uint32_t> indices{};  ///< two a primitive; empty: positions in order
  std::span<const float> radii{};            ///< one a position
  float radius = 1;
  std::span<const Vec4> colors{};  ///< one a position, linear along the axis
  bool caps = true;                ///< closed by flat discs; else open, and seen from inside, too
  std::uint32_t material = 0;

  [[nodiscard]] std::size_t size() const {
    return (indices.empty() ? positions.size() : indices.size()) / 2;
  }
  /// The position of end `i`, 0 or 1, of a primitive.
  [[nodiscard]] std::uint32_t end(std::uint64_t primitive, int i) const {
    const std::size_t k = static_cast<std::size_t>(primitive) * 2 + static_cast<std::size_t>(i);
    return indices.empty() ? static_cast<std::uint32_t>(k) : indices[k];
  }
};

/// Polylines with round joints and ends. A primitive is a segment: the convex hull of the spheres
/// about its two positions, so that neighbours share a sphere.
struct TubesView {
  std::span<const Vec3> positions{};
  /// Polyline i has positions [offsets[i], offsets[i + 1]); n + 1 that rise; empty: one polyline.
  std::span<const std::uint32_t> offsets{};
  std::span<const float> radii{};  ///< one a position
  float radius = 1;
  std::span<const Vec4> colors{};  ///< one a position, linear along the axis
  std::uint32_t material = 0;

  /// Segments. O(1).
  [[nodiscard]] std::size_t size() const;
  /// The position at which a segment begins; it ends at the next. O(log polylines).
  [[nodiscard]] std::size_t begin(std::uint64_t segment) const;
};

/// A primitive is a flat disc. It has two sides; its front is where its normal points to.
struct DiscsView {
  std::span<const Vec3> centers{};
  std::span<const Vec3> normals{};  ///< one a disc, need not be of unit length; 0 draws nothing
  std::span<const float> radii{};   ///< one a disc
  float radius = 1;
  std::span<const Vec4> colors{};  ///< one a disc
  std::uint32_t material = 0;

  [[nodiscard]] std::size_t size() const { return centers.size(); }
};

}  // namespace rastrum
