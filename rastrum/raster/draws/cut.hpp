// SPDX-License-Identifier: BSD-3-Clause
// Clip planes: what lies behind one is not there. Primitives are decided first: one that all planes
// keep is drawn as without them, one that a plane leaves nothing of is left out. Only fragments of
// the others are tested (kCut), before the maximum and so by every coverage and visibility.
//
// At a fragment the sign of Σ bᵢ sᵢ decides, with sᵢ the distance of vertex i in front of the plane
// and bᵢ > 0 its weight, linear on the screen. That needs no division and no clipped, snapped
// vertex. In float64: ((p x + q y) + r), with the weights' planes first summed over the corners in
// order. For a quadric it is the sign of n · h + offset · w at the point (h, w) of its side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

struct DrawCut {
  struct Plane {
    double x, y, z, offset;
  };
  std::vector<Plane> planes;  ///< in object space
  ArrayView<Vec3> positions;  ///< of its vertices; a quadric has none

  /// `world`: the frame's.
  DrawCut(const InstanceView& instance, std::span<const ClipPlane> world);

  [[nodiscard]] static double ahead(const Plane& plane, Vec3d p) {
    return ((plane.x * p.x + plane.y * p.y) + plane.z * p.z) + plane.offset;
  }
  [[nodiscard]] double ahead(const Plane& plane, std::uint32_t vertex) const {
    return ahead(plane, positions.wide(vertex));
  }
};

/// Throws Error{invalid_argument} that begins with `whose`: more than kMaxClipPlanes, or a plane
/// that is not finite or has no direction.
void check_clip_planes(std::span<const ClipPlane> planes, const char* whose);

/// The samples of `block.mask` where the piece's primitive is in front of its draw's planes.
/// `points` as FragmentTest's.
[[nodiscard]] std::uint64_t in_front(const FrameGeometry& frame, const Piece& piece,
                                     const Block& block, const ShadingPoints* points) noexcept;

}  // namespace rastrum::raster
