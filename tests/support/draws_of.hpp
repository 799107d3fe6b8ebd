// SPDX-License-Identifier: BSD-3-Clause
// Draws as a renderer makes them of positions and of meshes.
#pragma once

#include <vector>

#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/vertices.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::test {

/// Triangles of three positions each, or whatever else the caller makes of them; while these stay.
template <class Positions>
[[nodiscard]] raster::Draw draw_of(const Positions& positions, const Mat4d& to_clip) {
  raster::Draw draw;
  draw.source = raster::MatrixVertices(positions, to_clip);
  draw.vertex_count = positions.size();
  draw.primitive_count = draw.vertex_count / 3;
  return draw;
}

/// One of each instance, which are meshes.
[[nodiscard]] inline std::vector<raster::Draw> draws_of(const SceneView& scene,
                                                        const Mat4d& world_to_clip) {
  std::vector<raster::Draw> draws;
  for (const InstanceView& instance : scene.instances) {
    const MeshView& mesh = *instance.mesh();
    raster::Draw& draw =
        draws.emplace_back(draw_of(mesh.positions, world_to_clip * instance.object_to_world));
    draw.indices = mesh.indices.packed();
    draw.primitive_count = mesh.triangle_count();
  }
  return draws;
}

}  // namespace rastrum::test
