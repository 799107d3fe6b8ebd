#include <rastrum/raster/shade/scalar_mesh_shader.hpp>

#include <bit>
#include <optional>
#include <utility>

#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_scalar.hpp>

namespace rastrum::raster {

ScalarMeshShader::ScalarMeshShader(const SurfaceLook& look, const SceneView& scene,
                                   std::vector<SurfaceScalars> scalars, const Camera& camera,
                                   int width, int height, const TextureSet& textures)
    : look_(look),
      scalars_(std::move(scalars)),
      lit_(scene, camera, width, height),
      materials_(scene, camera, width, height, textures) {
  lit_.lights = materials_.lights = look.lights;
}

std::size_t ScalarMeshShader::scratch_bytes() const noexcept {
  return sizeof(KeptTriangles);
}

bool ScalarMeshShader::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa,
                             BlockColors& colors) const noexcept {
  KeptTriangles& kept = *static_cast<KeptTriangles*>(block.scratch);
  const LitView lit = lit_.view();
  const MaterialView materials = materials_.view();
  FragmentLocator locator(frame);
  std::optional<MaterialTriangle> triangle;  // that was seen last
  std::uint64_t triangle_id = 0;
  bool opaque = true;
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = block.x0 + i % kBlockSize, y = block.y0 + i / kBlockSize;
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    const std::uint64_t id = id_of_key(block.keys[i]);
    const Fragment& f = locator.locate(id, block.x0, block.y0, i, block.points);
    const Draw& draw = frame.draws[f.draw];
    const Vec4 own = scalars_[draw.number].color(f, Topology::triangles, !look_.model);
    const Vec3 base{own.x, own.y, own.z};
    Vec3 c;
    if (look_.model == LitModel::id) {
      c = id_color(id);
    } else if (look_.model == LitModel::wireframe) {
      const float line = wire_share(f);
      c = base * (1 - line) + kWireColor * line;
    } else if (look_.model) {
      const LitTriangle& t =
          kept.find(lit_, frame, block.keys[i] & kIdMask, look_.model != LitModel::flat);
      c = shade_lit(*look_.model, lit, t, x, y, from_centre, depth_of_key(block.keys[i]), &base);
    } else {
      if (!triangle || triangle_id != id) triangle.emplace(materials, frame, draw, id);
      triangle_id = id;
      c = shade_material(materials, *triangle, MaterialPoint(triangle->planes, x, y, from_centre),
                         linear_, depth_of_key(block.keys[i]), &base);
    }
    float alpha = 1;
    if (look_.blends) {
      const MaterialDraw& of = materials.draws[draw.number];
      const BoundMaterial& material = materials.material_of(of, f.triangle);
      alpha = clamped_alpha(look_.opacity * material.opacity * of.opacity * own.w);
    }
    opaque &= colors.set(i, {c.x * alpha, c.y * alpha, c.z * alpha, alpha});
  }
  return opaque;
}

std::uint64_t ScalarMeshShader::test(const FrameGeometry& frame, const Piece& piece,
                                     const Block& block,
                                     const ShadingPoints* points) const noexcept {
  const MaterialView materials = materials_.view();
  std::uint64_t kept = 0;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const Vec2 from_centre = points == nullptr ? Vec2{0, 0} : Vec2{points->dx[i], points->dy[i]};
    kept |= std::uint64_t{passes_mask(materials, frame, id_of_key(piece.low),
                                      block.bx * kBlockSize + i % kBlockSize,
                                      block.by * kBlockSize + i / kBlockSize, from_centre)}
            << i;
  }
  return kept;
}

}  // namespace rastrum::raster
