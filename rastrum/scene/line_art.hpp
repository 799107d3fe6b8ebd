// Lines from meshes, to be drawn with Topology::lines (raster/draws/geometry.hpp): wireframes and
// normals, as in paper 1 (render_wireframe, render_normals; section C.1.5). Each edge is here once,
// however many triangles share it.
#pragma once

#include <cstdint>
#include <vector>

#include <rastrum/scene/mesh.hpp>

namespace rastrum {

/// Pairs of position indices: the edges of the triangles, each once, in the order in which
/// triangles first name them. O(n log n). Indices need not be in range.
[[nodiscard]] std::vector<std::uint32_t> edge_indices(const MeshView& mesh);

/// Pairs of positions, object space: from each vertex `length` along its unit normal; where normals
/// have indices of their own, from each corner; where there are none, from the middle of each
/// triangle along the normal of its face. What has no direction is left out. Throws
/// Error{invalid_argument} for indices out of range.
[[nodiscard]] std::vector<Vec3> normal_lines(const MeshView& mesh, float length);

}  // namespace rastrum
