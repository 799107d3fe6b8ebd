// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes: MeshView over a caller's arrays, which is rendered, and Mesh, which owns its
// arrays and is what readers and procedural shapes return.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <rastrum/array.hpp>
#include <rastrum/color.hpp>
#include <rastrum/scalars.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// Which side of a triangle is its front: the one from which its vertices turn counter-clockwise,
/// or clockwise, or whichever is seen; then no face is culled.
enum class Winding : std::uint8_t { counter_clockwise, clockwise, either };

/// How the corners of a mesh (one for each index) make faces, and faces triangles.
enum class FaceKind : std::uint8_t {
  triangles,  ///< three corners each
  /// Four corners each: triangles (0, 1, 2) and (0, 2, 3). If one of these turns against the face
  /// and neither of (0, 1, 3) and (1, 2, 3) does, these two.
  quads,
  /// Runs of n corners, each n − 2 triangles: the fan (0, k + 1, k + 2). If a triangle of the fan
  /// turns against the face, because a corner points inwards, the face is cut ear by ear.
  polygons,
  strips,  ///< runs of corners: triangle k is (k, k + 1, k + 2), or (k + 1, k, k + 2) if odd
};

/// How a mesh's corners make its faces. `offsets`, for polygons and strips, has one more than
/// faces: face i has the corners offsets[i] to offsets[i + 1] (VTK's offsets and connectivity). A
/// face of two corners has no triangle; fewer are refused, as are offsets beyond the corners.
/// Empty: all corners are one face.
struct FacesView {
  FaceKind kind = FaceKind::triangles;
  IndexView offsets{};

  bool operator==(const FacesView&) const = default;
};

/// Where a triangle's corners and its face are among those of its mesh.
struct TrianglePlace {
  std::size_t corner[3];
  std::size_t face;
};

/// Values at the corners of triangles. With `indices`, one for each corner, corner c reads
/// values[indices[c]] (OBJ). Without, `per` says what each value belongs to: a position (glTF,
/// PLY), a corner, a face or the mesh.
template <class T>
struct AttributeView {
  ArrayView<T> values{};
  IndexView indices{};
  Per per = Per::vertex;

  bool operator==(const AttributeView&) const = default;
  [[nodiscard]] RASTRUM_HD bool empty() const { return values.empty(); }
  /// The place in `values` of corner c of a triangle; `vertex`: the positions of its corners.
  [[nodiscard]] RASTRUM_HD std::size_t element(const TrianglePlace& t,
                                               const std::uint32_t (&vertex)[3],
                                               std::size_t c) const {
    if (!indices.empty()) return indices[t.corner[c]];
    if (per == Per::vertex) return vertex[c];
    return per == Per::corner ? t.corner[c] : per == Per::face ? t.face : 0;
  }
  [[nodiscard]] RASTRUM_HD T at(const TrianglePlace& t, const std::uint32_t (&vertex)[3],
                                std::size_t c) const {
    return values[element(t, vertex, c)];
  }
  /// The values of all three corners at once, which is faster.
  RASTRUM_HD void corners(const TrianglePlace& t, const std::uint32_t (&vertex)[3],
                          T (&out)[3]) const {
    if (indices.empty() && per == Per::vertex && values.is_packed()) {
      const T* const packed = values.data();
      for (int c = 0; c < 3; ++c) out[c] = packed[vertex[c]];
      return;
    }
    for (std::size_t c = 0; c < 3; ++c) out[c] = at(t, vertex, c);
  }
};

struct RASTRUM_INSIDE MeshClusters;  // scene/mesh_clusters.hpp
class RASTRUM_INSIDE FaceCuts;       // scene/face_cuts.hpp

/// A mesh over the caller's arrays, of any types and strides (array.hpp); nothing is copied, so
/// they must outlive the render. Counter-clockwise is front. Every index must be < its array's
/// size; the render checks this. At most 2³² − 1 positions.
struct MeshView {
  ArrayView<Vec3> positions{};  ///< object space; float64 is transformed in float64
  IndexView indices{};          ///< one for each corner; empty: positions in order
  /// Need not be of unit length; empty: face normals. A corner whose normal is zero or not finite
  /// has its face's.
  AttributeView<Vec3> normals{};
  AttributeView<Vec2> texcoords{};  ///< (0, 0) is the top left of a texture, as in glTF
  AttributeView<Vec4> colors{};     ///< straight alpha; multiplies the base colour
  ColorSpace color_space = ColorSpace::display;  ///< the meaning of `colors`
  IndexView face_materials{};                    ///< one for each face; empty: `material`
  std::uint32_t material = 0;                    ///< index into Scene::materials
  FacesView faces{};
  MeshScalarsView scalars{};  ///< numbers that become colours: InstanceView::scalar_mapping
  /// Set by PreparedMesh (prepared_mesh.hpp): clusters of triangles. Frames leave out hidden ones.
  const MeshClusters* clusters = nullptr;
  /// Set while a picture is drawn: how polygons that are no fans are cut.
  const FaceCuts* cuts = nullptr;

  /// Whether both view the same memory in the same way.
  bool operator==(const MeshView&) const = default;
  [[nodiscard]] std::size_t corner_count() const {
    return indices.empty() ? positions.size() : indices.size();
  }
  [[nodiscard]] std::size_t face_count() const;
  [[nodiscard]] std::size_t triangle_count() const;
  /// The index of a corner's position.
  [[nodiscard]] RASTRUM_HD std::uint32_t vertex(std::size_t corner) const {
    return indices.empty() ? static_cast<std::uint32_t>(corner) : indices[corner];
  }
  /// The corners and the face of triangle t < triangle_count(). Requires valid faces and indices.
  /// O(log faces) with offsets, else O(1); for a polygon without `cuts` also O(its corners).
  [[nodiscard]] RASTRUM_HD TrianglePlace place(std::size_t t) const {
#if !defined(__CUDA_ARCH__)
    if (faces.kind != FaceKind::triangles) return place_in_face(t);
#endif
    return {{3 * t, 3 * t + 1, 3 * t + 2}, t};
  }
  /// Writes the indices of the positions of triangles first to first + n, three each. Requires
  /// valid faces. O(n + log faces); for polygons without `cuts` also O(the corners of the first and
  /// the last).
  void read_triangles(std::size_t first, std::size_t n, std::uint32_t* vertices) const;
  /// Whether its triangles are a list that a device reads: packed indices, or none, and no faces of
  /// another kind.
  [[nodiscard]] bool is_packed_list() const {
    return faces.kind == FaceKind::triangles && indices.is_packed();
  }

 private:
  [[nodiscard]] TrianglePlace place_in_face(std::size_t t) const;
};

/// Throws Error{invalid_argument} that names the first offset that is out of order or range, or the
/// first corner whose index is no position's. O(offsets + indices).
void check_indices(const MeshView& mesh);

/// The arrays of an AttributeView; without `indices` there is one value for each position.
template <class T>
struct Attribute {
  std::vector<T> values{};
  std::vector<std::uint32_t> indices{};  ///< empty: as the positions'

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] AttributeView<T> view() const;
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
  std::vector<NamedScalars> scalars{};  ///< Scene::shown_scalars names the one that is shown
  ColorSpace color_space = ColorSpace::display;
  /// Positions in float64, for files far from 0 (docs/read_files.md); `positions` holds them
  /// rounded. Drawn in place of `positions` unless empty.
  std::vector<Vec3d> wide_positions{};

  [[nodiscard]] MeshView view() const;
  [[nodiscard]] std::size_t triangle_count() const;
};

// Vertex normals that leave sharp edges sharp.

/// Normals at the corners of triangles, smooth across the edges whose triangles meet at an angle of
/// at most `crease_deg`, in [0, 180]. At each point the triangles around it fall into groups that
/// are joined by such edges. The corners of a group share the normalized sum of the cross products
/// of its triangles' edges (area-weighted, as vertex_normals).
///
/// `indices`: three for each triangle; empty: positions in order. Equal positions are one point, so
/// a triangle soup has neighbours, too. Where more than two triangles share an edge, each is
/// compared with the next in their order. Edges of triangles without an area join nothing; the
/// normal at the corners of such triangles, and of those that are not finite, is (0, 0, 0).
///
/// Returns `values`, one for each group, and `indices`, one for each corner, to be set:
/// `mesh.normals = crease_normals(…)`. Positions, triangles and their order stay as they are. The
/// bits are the same on every machine: sums are float64 in the order of triangles, and angles are
/// compared by cosines, which the library computes itself.
/// Cost: O(triangles · log(triangles at a point)), about 100 bytes per triangle meanwhile. Many
/// triangles are shared out to all threads.
/// Throws Error{invalid_argument} for an index or an angle out of range.
[[nodiscard]] Attribute<Vec3> crease_normals(const ArrayView<Vec3>& positions,
                                             std::span<const std::uint32_t> indices,
                                             double crease_deg);

// Lines from meshes, to be drawn with Topology::lines (program.hpp): wireframes and normals, as in
// paper 1 (render_wireframe, render_normals; section C.1.5). Each edge comes once, however many
// triangles share it.

/// The edges of the triangles, each once, as pairs of position indices, in the order in which
/// triangles first name them. O(n log n). Indices need not be in range.
[[nodiscard]] std::vector<std::uint32_t> edge_indices(const MeshView& mesh);

/// Lines along the normals, as pairs of positions in object space: from each vertex `length` along
/// its unit normal; from each corner if normals are not one for each vertex; without normals from
/// the middle of each triangle along its face's. Normals without a direction are left out. Throws
/// Error{invalid_argument} for indices out of range.
[[nodiscard]] std::vector<Vec3> normal_lines(const MeshView& mesh, float length);

}  // namespace rastrum
