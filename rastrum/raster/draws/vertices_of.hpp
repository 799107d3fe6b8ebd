// SPDX-License-Identifier: BSD-3-Clause
// Makes draws from the instances of a scene.
#pragma once

#include <rastrum/mat.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// The positions of a mesh, points or lines, and what they make up. Null: the geometry has no
/// vertices.
struct VertexList {
  const ArrayView<Vec3>* positions = nullptr;
  Topology topology = Topology::triangles;
};
[[nodiscard]] VertexList vertices_of(GeometryRef geometry);

/// Makes `draw` one of a mesh, points or lines, which must outlive the frame. Returns false for
/// other geometry, and leaves `draw` as it is.
bool set_vertices(Draw& draw, GeometryRef geometry, const Mat4d& object_to_clip);

/// Makes `draw` one of `count` consecutive instances of `mesh`. All must outlive the frame.
void set_copies(Draw& draw, const MeshView& mesh, const InstanceView* instances, std::size_t count,
                const Mat4d& world_to_clip);

}  // namespace rastrum::raster
