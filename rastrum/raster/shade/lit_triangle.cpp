// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/lit_triangle.hpp>

namespace rastrum::raster {
void fetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                    bool wants_normals, LitTriangle& out) {
  const Draw& draw = frame.draw_of(kIdMask - low);
  fetch_triangle(scene.view(), scene.of(frame, draw), frame, draw, low, wants_normals, out);
}

void prefetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t id,
                       bool wants_normals) noexcept {
  const Draw& draw = frame.draw_of(id);
  const MeshView& mesh = *scene.draws[draw.number].mesh;
  const ProjectedVertex* const projected = frame.projected_of(draw);
  std::uint32_t vertex[3];
  draw.vertices(id - draw.first_id, vertex);
  if (projected != nullptr)
    for (const std::uint32_t v : vertex) __builtin_prefetch(projected + v);
  if (!wants_normals) return;
  const bool flat = mesh.normals.empty();
  const ArrayView<Vec3>& read = flat ? mesh.positions : mesh.normals.values;
  if (!read.is_packed() || !(flat || mesh.normals.indices.empty())) return;
  // The cache has a mesh that is drawn many times.
  if (draw.is_copied()) return;
  for (const std::uint32_t v : vertex) __builtin_prefetch(read.data() + v);
}

}  // namespace rastrum::raster
