#include <rastrum/raster/shade/lit_triangle.hpp>

namespace rastrum::raster {
void fetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t low,
                    bool wants_normals, LitTriangle& out) {
  fetch_triangle(scene.view(), frame, low, wants_normals, out);
}

void prefetch_triangle(const LitScene& scene, const FrameGeometry& frame, std::uint64_t id,
                       bool wants_normals) noexcept {
  const Draw& draw = frame.draw_of(id);
  const MeshView& mesh = *scene.draws[draw.number].mesh;
  const ProjectedVertex* const projected = frame.projected_of(draw);
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t v = draw.vertex(id - draw.first_id, c);
    if (projected != nullptr) __builtin_prefetch(projected + v);
    if (!wants_normals) continue;
    if (mesh.normals.empty()) {
      if (mesh.positions.is_packed()) __builtin_prefetch(mesh.positions.data() + v);
    } else if (mesh.normals.indices.empty() && mesh.normals.values.is_packed()) {
      __builtin_prefetch(mesh.normals.values.data() + v);
    }
  }
}

}  // namespace rastrum::raster
