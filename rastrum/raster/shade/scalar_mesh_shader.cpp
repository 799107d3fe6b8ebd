#include <rastrum/raster/shade/scalar_mesh_shader.hpp>

#include <algorithm>
#include <bit>
#include <utility>

#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>
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
  for (const SurfaceScalars& s : scalars_) isolines_ |= s.colors()->has_isolines();
}

std::size_t ScalarMeshShader::scratch_bytes() const noexcept {
  return sizeof(KeptTriangles);
}

bool ScalarMeshShader::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                             BlockColors& colors) const noexcept {
  LitBlock surface;
  if (block.covered != ~std::uint64_t{0}) std::fill_n(surface.base[0], 3 * 64, 0.0F);
  alignas(64) float alpha[64];
  FragmentLocator locator(frame);
  const MaterialView materials = materials_.view();
  const bool is_wire = look_.model == LitModel::wireframe;
  double corner[3] = {};
  std::uint64_t corners_of = kMaxId + 1;  // the triangle that they are of
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    const Fragment& f = locator.locate(id, block.x0, block.y0, i, block.points, isolines_);
    const std::size_t number = frame.draws[f.draw].number;
    const SurfaceScalars& scalars = scalars_[number];
    if (id != corners_of) scalars.at_corners(f, Topology::triangles, corner);
    corners_of = id;
    const Vec4 own = scalars.color(corner, f.weights, Topology::triangles, !look_.model);
    Vec3 base{own.x, own.y, own.z};
    if (is_wire) {
      const float line = wire_share(f);
      base = base * (1 - line) + kWireColor * line;
    } else if (look_.model == LitModel::id) {
      base = id_color(id);
    }
    surface.base[0][i] = base.x;
    surface.base[1][i] = base.y;
    surface.base[2][i] = base.z;
    alpha[i] = 1;
    if (look_.blends) {
      const MaterialDraw& of = materials.draws[number];
      const BoundMaterial& material = materials.material_of(of, f.triangle);
      alpha[i] = clamped_alpha(look_.opacity * material.opacity * of.opacity * own.w);
    }
  }
  light(frame, block, isa, surface, colors);
  bool opaque = true;
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const float a = alpha[i];
    opaque &= colors.set(i, {colors.r[i] * a, colors.g[i] * a, colors.b[i] * a, a});
  }
  return opaque;
}

void ScalarMeshShader::light(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                             LitBlock& surface, BlockColors& colors) const {
  if (!look_.model) {
    material_kernels(isa).shade(materials_.view(), frame, block, linear_, surface.base[0], colors);
    return;
  }
  const bool is_final = look_.model == LitModel::wireframe || look_.model == LitModel::id;
  if (!is_final && isa != Isa::scalar &&
      shade_own_base_simd(isa, *look_.model, lit_, frame, block, surface, colors))
    return;
  KeptTriangles& kept = *static_cast<KeptTriangles*>(block.scratch);
  const LitView lit = lit_.view();
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = block.x0 + i % kBlockSize, y = block.y0 + i / kBlockSize;
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    Vec3 c{surface.base[0][i], surface.base[1][i], surface.base[2][i]};
    if (!is_final) {
      const LitTriangle& t =
          kept.find(lit_, frame, block.keys[i] & kIdMask, look_.model != LitModel::flat);
      const Vec3 base = c;
      c = shade_lit(*look_.model, lit, t, x, y, from_centre, depth_of_key(block.keys[i]), &base);
    }
    colors.set(i, {c.x, c.y, c.z, 1});
  }
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
