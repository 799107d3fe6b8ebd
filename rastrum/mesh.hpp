// Triangle meshes: views over a caller's arrays (what is rendered) and the owning form (what
// readers and procedural shapes return).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <rastrum/vec.hpp>

namespace rastrum {

/// Which side of a triangle is its front: where its vertices turn counter-clockwise on the screen,
/// clockwise, or whichever is seen; then no face is culled.
enum class Winding : std::uint8_t { counter_clockwise, clockwise, either };

/// Values at the corners of triangles. Corner c of triangle t reads `values[indices[3t + c]]`;
/// where `indices` is empty it reads `values` by the position's index, so that an attribute may
/// share the positions' numbering (glTF, PLY) or have its own (OBJ).
template <class T>
struct AttributeView {
  std::span<const T> values{};
  std::span<const std::uint32_t> indices{};

  [[nodiscard]] bool empty() const { return values.empty(); }
};

/// A triangle mesh over the caller's arrays; nothing is copied, so they must outlive the render.
/// Counter-clockwise is front. Every index must be < its array's size; the render checks this.
struct MeshView {
  std::span<const Vec3> positions{};         ///< object space
  std::span<const std::uint32_t> indices{};  ///< 3 per triangle; empty: positions in order
  AttributeView<Vec3> normals{};             ///< need not be unit length; empty: face normals
  AttributeView<Vec2> texcoords{};           ///< (0, 0) is the top left of a texture, as in glTF
  AttributeView<Vec4> colors{};              ///< linear, straight alpha; multiplies the base colour
  std::span<const std::uint32_t> face_materials{};  ///< one per triangle; empty: `material` for all
  std::uint32_t material = 0;                       ///< index into Scene::materials

  [[nodiscard]] std::size_t triangle_count() const {
    return (indices.empty() ? positions.size() : indices.size()) / 3;
  }
  /// The position of corner 3t + c, c of triangle t.
  [[nodiscard]] std::uint32_t vertex(std::size_t corner) const {
    return indices.empty() ? static_cast<std::uint32_t>(corner) : indices[corner];
  }
};

/// Throws Error{invalid_argument} that names the first of the triangles' indices that is no
/// position's. O(indices).
void check_indices(const MeshView& mesh);

template <class T>
struct Attribute {
  std::vector<T> values{};
  std::vector<std::uint32_t> indices{};  ///< empty: the positions' indices

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] AttributeView<T> view() const { return {values, indices}; }
};

/// A mesh that owns its arrays; the meaning of each is MeshView's.
struct Mesh {
  std::string name{};
  std::vector<Vec3> positions{};
  std::vector<std::uint32_t> indices{};
  Attribute<Vec3> normals{};
  Attribute<Vec2> texcoords{};
  Attribute<Vec4> colors{};
  std::vector<std::uint32_t> face_materials{};
  std::uint32_t material = 0;

  [[nodiscard]] MeshView view() const {
    return {positions,     indices,        normals.view(), texcoords.view(),
            colors.view(), face_materials, material};
  }
  [[nodiscard]] std::size_t triangle_count() const { return view().triangle_count(); }
};

// Vertex normals that leave sharp edges sharp.

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
/// the order of triangles in float64, and cosines are compared, which are our own.
/// Cost: O(triangles · log(triangles at a point)), about 100 bytes a triangle meanwhile.
/// Throws Error{invalid_argument} for an index or an angle out of range.
[[nodiscard]] Attribute<Vec3> crease_normals(std::span<const Vec3> positions,
                                             std::span<const std::uint32_t> indices,
                                             double crease_deg);

// Lines from meshes, to be drawn with Topology::lines (program.hpp): wireframes and
// normals, as in paper 1 (render_wireframe, render_normals; section C.1.5). Each edge is here once,
// however many triangles share it.

/// Pairs of position indices: the edges of the triangles, each once, in the order in which
/// triangles first name them. O(n log n). Indices need not be in range.
[[nodiscard]] std::vector<std::uint32_t> edge_indices(const MeshView& mesh);

/// Pairs of positions, object space: from each vertex `length` along its unit normal; where normals
/// have indices of their own, from each corner; where there are none, from the middle of each
/// triangle along the normal of its face. What has no direction is left out. Throws
/// Error{invalid_argument} for indices out of range.
[[nodiscard]] std::vector<Vec3> normal_lines(const MeshView& mesh, float length);

}  // namespace rastrum
