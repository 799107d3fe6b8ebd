// SPDX-License-Identifier: BSD-3-Clause
// A draw of the pipeline: points, lines or triangles with vertices from any source, or quadrics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/config.hpp>
#include <rastrum/points_and_lines.hpp>
#include <rastrum/primitives.hpp>
#include <rastrum/raster/draws/shading.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/quadrics.hpp>

namespace rastrum {
struct ProgramDraw;  // program.hpp
}

namespace rastrum::raster {

struct DrawCut;

/// A mesh drawn many times, under one matrix after the other. The draw has its triangles and
/// vertices once for each copy, copy after copy.
struct Copies {
  std::uint64_t count = 1;
  std::uint64_t primitives = 0;  ///< of one copy, like `vertices`; 0 if there is only one
  std::uint32_t vertices = 0;
};

/// A draw's first vertex where it has no place in FrameGeometry::projected.
inline constexpr std::size_t kNotProjected = ~std::size_t{0};

/// Primitives with one vertex stage. Their flags become those of its pieces.
struct Draw : Primitives {
  Draw() = default;
  Draw(const ProgramDraw& draw);

  VertexStage source;  ///< must be set without `quadrics`
  /// The primitives, if set. They have no vertices, and the topology says nothing.
  const QuadricStage* quadrics = nullptr;
  /// Flags by material, so that a mesh of several materials needs one draw: triangle t also has the
  /// flags material_flags[face_materials[t]]. Both are set or neither.
  IndexView face_materials{};  ///< of the faces of a mesh, if there is one
  std::span<const std::uint32_t> material_flags{};
  /// The mesh of the triangles where they are no packed list (MeshView::faces, indices of other
  /// types). It must outlive the frame. Null: `indices` has the corners. For the host only.
  const MeshView* mesh = nullptr;
  /// The same for points or lines of a scene and for sizes of points. At most one of the three is
  /// set.
  const PointsView* points = nullptr;
  const LinesView* lines = nullptr;
  /// The clusters of a prepared mesh in frames that draw by clusters (cull/selection.hpp), else
  /// null. For the host only.
  const MeshClusters* clusters = nullptr;
  Copies copies{};      ///< of the mesh; for the host only
  bool visible = true;  ///< else its primitives are culled
  /// The draw's own shader, and the test of its fragments where `flags` has kTested. Empty: the
  /// frame's.
  Shading shading;
  Testing test;
  const DrawCut* cut = nullptr;  ///< its clip planes (cut.hpp); must outlive the frame

  // Filled by the pipeline.
  std::uint64_t first_id = 0;
  std::size_t first_vertex = 0;  ///< in FrameGeometry::projected, or kNotProjected
  std::size_t number = 0;        ///< among the draws with its shading
  bool is_projected = false;     ///< all its vertices are there, not only some clusters'

  /// Draws the triangles of mesh `of`, `count` times. The mesh must outlive the frame.
  void set_triangles(const MeshView& of, std::size_t count = 1) {
    if (of.is_packed_list())
      indices = of.indices.packed();
    else
      mesh = &of;
    clusters = of.clusters;
    if (count > 1)
      copies = {count, of.triangle_count(), static_cast<std::uint32_t>(of.positions.size())};
    vertex_count = of.positions.size() * count;
    primitive_count = of.triangle_count() * count;
  }
  void set_points(const PointsView& of) {
    points = &of;
    topology = Topology::points;
    point_size = of.point_size;
    vertex_count = of.positions.size();
    primitive_count = of.size();
  }
  void set_lines(const LinesView& of) {
    lines = &of;
    topology = Topology::lines;
    line_width = of.line_width;
    vertex_count = of.positions.size();
    primitive_count = of.size();
  }
  /// A primitive within its copy.
  struct OfCopy {
    std::uint64_t copy = 0, primitive = 0;
  };
  [[nodiscard]] RASTRUM_HD bool is_copied() const {
#if defined(__CUDA_ARCH__)
    return false;
#else
    return copies.count > 1;
#endif
  }
  [[nodiscard]] RASTRUM_HD OfCopy of_copy(std::uint64_t primitive) const {
    if (!is_copied()) return {0, primitive};
    return {primitive / copies.primitives, primitive % copies.primitives};
  }
  [[nodiscard]] RASTRUM_HD std::uint32_t first_vertex_of(std::uint64_t copy) const {
    return static_cast<std::uint32_t>(copy) * copies.vertices;
  }
  [[nodiscard]] std::uint64_t own_primitives() const {
    return primitive_count / copies.count;
  }
  [[nodiscard]] std::size_t own_vertices() const {
    return vertex_count / copies.count;
  }

  [[nodiscard]] RASTRUM_HD std::uint32_t vertex(std::uint64_t primitive, int corner) const {
    if (is_copied()) {
      const OfCopy of = of_copy(primitive);
      return first_vertex_of(of.copy) + own_vertex(of.primitive, corner);
    }
    return own_vertex(primitive, corner);
  }
  /// `primitive` and the result are within one copy.
  [[nodiscard]] RASTRUM_HD std::uint32_t own_vertex(std::uint64_t primitive, int corner) const {
#if !defined(__CUDA_ARCH__)
    if (mesh != nullptr)
      return mesh->vertex(mesh->place(primitive).corner[static_cast<std::size_t>(corner)]);
    if (points != nullptr) return points->vertex(primitive);
    if (lines != nullptr) return lines->vertex(primitive, corner);
#endif
    const std::size_t i = static_cast<std::size_t>(primitive) * static_cast<std::size_t>(topology) +
                          static_cast<std::size_t>(corner);
    return indices.empty() ? static_cast<std::uint32_t>(i) : indices[i];
  }
  /// Decides once, not per corner, where vertices are read.
  RASTRUM_HD void vertices(std::uint64_t triangle, std::uint32_t (&out)[3]) const {
    const bool is_list =
        mesh == nullptr && points == nullptr && lines == nullptr && !indices.empty();
    const OfCopy of = of_copy(triangle);
    const std::uint32_t* const packed =
        is_list ? indices.data() + static_cast<std::size_t>(of.primitive) * 3 : nullptr;
    const std::uint32_t first = first_vertex_of(of.copy);
    for (int c = 0; c < 3; ++c)
      out[c] = first + (packed != nullptr ? packed[c] : own_vertex(of.primitive, c));
  }
  /// The indices of the corners, from whichever view has them.
  [[nodiscard]] IndexView index_view() const {
    if (mesh != nullptr) return mesh->indices;
    if (points != nullptr) return points->indices;
    return lines != nullptr ? lines->indices : IndexView(indices);
  }
  [[nodiscard]] RASTRUM_HD std::uint32_t flags_of(std::uint64_t primitive) const {
    if (material_flags.empty()) return flags;
    auto face = static_cast<std::size_t>(of_copy(primitive).primitive);
#if !defined(__CUDA_ARCH__)
    if (mesh != nullptr) face = mesh->place(face).face;
#endif
    return flags | material_flags[face_materials[face]];
  }
  /// In px.
  [[nodiscard]] RASTRUM_HD float size_of(std::uint64_t primitive) const {
#if !defined(__CUDA_ARCH__)
    if (points != nullptr && !points->sizes.empty()) return points->sizes[vertex(primitive, 0)];
#endif
    return point_size;
  }
  [[nodiscard]] RASTRUM_HD bool is_round() const {
    return points != nullptr && points->round;
  }
  [[nodiscard]] std::uint32_t any_flags() const {
    std::uint32_t any = flags;
    for (const std::uint32_t f : material_flags) any |= f;
    return any;
  }
  /// `cull` for counter-clockwise fronts, whatever `winding` is.
  [[nodiscard]] RASTRUM_HD Cull effective_cull() const {
    return effective_cull(cull, winding);
  }
  [[nodiscard]] RASTRUM_HD static Cull effective_cull(Cull cull, Winding winding) {
    if (cull == Cull::none || winding == Winding::either) return Cull::none;
    const bool swap = winding == Winding::clockwise;
    return (cull == Cull::back) != swap ? Cull::back : Cull::front;
  }
  /// Whether the setup kernel makes its pieces; else assemble_primitive does.
  [[nodiscard]] bool has_kernel() const {
    return may_have_kernel(Topology::triangles);
  }
  /// Whether the points kernel may make its fragments.
  [[nodiscard]] bool has_points_kernel() const {
    return may_have_kernel(Topology::points);
  }

 private:
  [[nodiscard]] bool may_have_kernel(Topology of) const {
    return visible && quadrics == nullptr && topology == of && depth_bias == 0 &&
           depth_bias_slope == 0;
  }
};

/// The draw that holds primitive `id`. O(log draws).
[[nodiscard]] RASTRUM_HD inline const Draw& draw_with(std::span<const Draw> draws,
                                                      std::uint64_t id) {
  std::size_t low = 0;
  std::size_t high = draws.size();
  // Instances of one mesh have equally many primitives. Then the first guess is the draw or its
  // neighbour.
  if (high > 16) {
    const std::uint64_t first = draws[0].first_id;
    const std::uint64_t ids = draws[high - 1].first_id + draws[high - 1].primitive_count - first;
    const auto guess = static_cast<std::size_t>(
        static_cast<double>(id - first) / static_cast<double>(ids) * static_cast<double>(high));
    if (guess < high && draws[guess].first_id <= id) {
      low = guess;
      if (guess + 2 < high && id < draws[guess + 2].first_id) high = guess + 2;
    } else if (guess < high) {
      high = guess;
      if (guess >= 2 && draws[guess - 2].first_id <= id) low = guess - 2;
    }
  }
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (draws[middle].first_id <= id ? low : high) = middle;
  }
  return draws[low];
}

}  // namespace rastrum::raster
