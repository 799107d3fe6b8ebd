// Vertex normals that leave sharp edges sharp.
#pragma once

#include <cstdint>
#include <span>

#include <rastrum/core/vec.hpp>
#include <rastrum/scene/mesh.hpp>

namespace rastrum {

/// Normals at the corners of triangles, smooth across the edges whose triangles meet at an angle of
/// at most `crease_deg`, in [0, 180]: at each point the triangles around it fall into groups that
/// are joined by such edges, and the corners of a group share the normalized sum of the cross
/// products of its triangles' edges (area-weighted, as vertex_normals).
///
/// `indices`: three a triangle; empty: positions in order. Equal positions are one point, so that a
/// triangle soup has neighbours, too. Where more than two triangles share an edge, each is compared
/// with the next in their order. Edges of triangles without an area join nothing; the normal of
/// their corners, and of those that are not finite, is (0, 0, 0).
///
/// Returns `values`, one a group, and `indices`, one a corner: `mesh.normals = crease_normals(…)`.
/// Positions, triangles and their order stay as they are. The same bits on every machine: sums in
/// the order of triangles in float64, and cosines are compared, which core/angle.hpp makes.
/// Cost: O(triangles · log(triangles at a point)), about 100 bytes a triangle meanwhile.
/// Throws Error{invalid_argument} for an index or an angle out of range.
[[nodiscard]] Attribute<Vec3> crease_normals(std::span<const Vec3> positions,
                                             std::span<const std::uint32_t> indices,
                                             double crease_deg);

}  // namespace rastrum
