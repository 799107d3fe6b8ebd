// SPDX-License-Identifier: BSD-3-Clause
// Clip planes: what lies behind one of them is not there. Decided for each primitive first: those
// that all planes keep are drawn as without them, those that one plane leaves nothing of are left
// out, and only the fragments of the others are asked for (kCut), before the maximum and so by
// every coverage and visibility.
//
// At a fragment the sign of Σ bᵢ sᵢ decides, with sᵢ how far vertex i lies in front of the plane
// and bᵢ > 0 its weight, linear on the screen: no division, and no clipped vertex that would be
// snapped. In float64: ((p x + q y) + r), the planes of the weights first summed over the corners
// in order. At a quadric's it is the sign of n · h + offset · w at the point (h, w) of its side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// The planes of a draw.
struct DrawCut {
  struct Plane {
    double x, y, z, offset;
  };
  std::vector<Plane> planes;  ///< in object space
  ArrayView<Vec3> positions;  ///< of its vertices; of a quadric none

  /// `world`: the frame's.
  DrawCut(const InstanceView& instance, std::span<const ClipPlane> world);

  [[nodiscard]] static double ahead(const Plane& plane, Vec3d p) {
    return ((plane.x * p.x + plane.y * p.y) + plane.z * p.z) + plane.offset;
  }
  [[nodiscard]] double ahead(const Plane& plane, std::uint32_t vertex) const {
    return ahead(plane, positions.wide(vertex));
  }
};

/// Throws Error{invalid_argument} that begins with `whose` for more than kMaxClipPlanes and for a
/// plane that is not finite or has no direction.
void check_clip_planes(std::span<const ClipPlane> planes, const char* whose);

/// The samples of `block.mask` at which the piece's primitive lies in front of its draw's planes.
/// `points` as FragmentTest's.
[[nodiscard]] std::uint64_t in_front(const FrameGeometry& frame, const Piece& piece,
                                     const Block& block, const ShadingPoints* points) noexcept;

}  // namespace rastrum::raster
