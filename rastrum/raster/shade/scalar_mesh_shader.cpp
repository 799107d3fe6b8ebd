// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/scalar_mesh_shader.hpp>

#include <algorithm>
#include <bit>
#include <utility>

#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>
#include <rastrum/raster/shade/material_scalar.hpp>
#include <rastrum/raster/shade/wire.hpp>
#include <rastrum/raster/surface/seen_planes.hpp>

namespace rastrum::raster {

ScalarMeshShader::ScalarMeshShader(const SurfaceLook& look, const SceneView& scene,
                                   std::vector<SurfaceScalars> scalars, const Camera& camera,
                                   int width, int height, const TextureSet& textures)
    : look_(look),
      scalars_(std::move(scalars)),
      lit_(scene, camera, width, height),
      materials_(scene, camera, width, height, textures, look.classic) {
  lit_.lights = materials_.lights = look.lights;
  for (const SurfaceScalars& s : scalars_) isolines_ |= s.colors()->has_isolines();
  const auto is_ramp = [](const SurfaceScalars& s) { return s.colors()->is_ramp(); };
  if (!std::ranges::all_of(scalars_, is_ramp)) return;
  std::vector<const ScalarColors*> mappings;
  for (const SurfaceScalars& s : scalars_) {
    auto at = std::ranges::find(mappings, s.colors());
    if (at == mappings.end()) {
      at = mappings.insert(at, s.colors());
      ramps_.emplace_back(*s.colors());
    }
    ramp_of_.push_back(static_cast<std::uint32_t>(at - mappings.begin()));
  }
}

std::size_t ScalarMeshShader::scratch_bytes() const noexcept {
  return sizeof(KeptTriangles);
}

float ScalarMeshShader::opacity_of(const Fragment& f, std::size_t number) const {
  const MaterialView materials = materials_.view();
  const MaterialDraw& of = materials.draws[number];
  return look_.opacity * materials.material_of(of, f.triangle).opacity * of.opacity;
}

void ScalarMeshShader::color_each(const FrameGeometry& frame, const VisibleBlock& block,
                                  LitBlock& surface, float (&alpha)[64]) const {
  FragmentLocator locator(frame);
  const bool is_wire = look_.model == Shader::wireframe;
  double corner[3] = {};
  std::uint64_t corners_of = kMaxId + 1;  // their triangle
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    const LocatedFragment& f = locator.locate(id, block.x0, block.y0, i, block.points, isolines_);
    const std::size_t number = frame.draws[f.draw].number;
    const SurfaceScalars& scalars = scalars_[number];
    if (id != corners_of) scalars.at_corners(f, Topology::triangles, corner);
    corners_of = id;
    const Vec4 own = scalars.color(corner, f.weights, Topology::triangles, look_.is_linear());
    Vec3 base{own.x, own.y, own.z};
    if (is_wire) {
      const float line = wire_share(f);
      base = base * (1 - line) + kWireColor * line;
    } else if (look_.model == Shader::id) {
      base = id_color(id);
    }
    surface.base[0][i] = base.x;
    surface.base[1][i] = base.y;
    surface.base[2][i] = base.z;
    alpha[i] = look_.blends ? clamped_alpha(opacity_of(f, number) * own.w) : 1;
  }
}

void ScalarMeshShader::color_all(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                                 LitBlock& surface, float (&alpha)[64]) const {
  const SeenKernels& kernels = *seen_kernels(isa);
  SeenPlanes seen;
  kernels.see(frame, block, seen);
  ByCorner shares;
  kernels.shares(seen, block, shares);
  ByCorner corner;
  float opacity[64];
  for (std::size_t k = 0; k < seen.count; ++k) {
    const Fragment f = seen.fragment(k);
    const std::size_t number = seen.draw[k]->number;
    double at[3];
    scalars_[number].at_corners(f, Topology::triangles, at);
    for (std::size_t c = 0; c < 3; ++c) corner[c][k] = at[c];
    opacity[k] = look_.blends ? opacity_of(f, number) : 1;
  }
  Numbers64 value{};
  kernels.numbers(seen, shares, block.covered, corner, value);
  for (std::uint64_t rest = block.covered; rest != 0;) {  // by colour ramp
    const auto ramp = [&](std::size_t k) { return ramp_of_[seen.draw[k]->number]; };
    const std::uint32_t first = ramp(seen.place[std::countr_zero(rest)]);
    std::uint64_t mine = ramps_.size() == 1 ? rest : seen.pixels_where(rest, [&](std::size_t k) {
      return ramp(k) == first;
    });
    rest &= ~mine;
    MappedColors colors;
    map_numbers(isa)(ramps_[first], value.data(), colors);
    for (; mine != 0; mine &= mine - 1) {
      const int i = std::countr_zero(mine);
      const std::size_t k = seen.place[i];
      Vec4 c{colors.r[i], colors.g[i], colors.b[i], colors.a[i]};
      if (isolines_) {
        const PixelPoint p = pixel_point(block.x0, block.y0, i, block.points);
        c = scalars_[seen.draw[k]->number].with_isolines(
            c, value[static_cast<std::size_t>(i)], {corner[0][k], corner[1][k], corner[2][k]},
            weights_at(seen.planes.at(k), p.x, p.y, p.from_centre), Topology::triangles);
      }
      surface.base[0][i] = look_.is_linear() ? linear_from_display(c.x) : c.x;
      surface.base[1][i] = look_.is_linear() ? linear_from_display(c.y) : c.y;
      surface.base[2][i] = look_.is_linear() ? linear_from_display(c.z) : c.z;
      alpha[i] = look_.blends ? clamped_alpha(opacity[k] * c.w) : 1;
    }
  }
}

bool ScalarMeshShader::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                             BlockColors& colors) const noexcept {
  LitBlock surface;
  if (block.covered != ~std::uint64_t{0}) std::fill_n(surface.base[0], 3 * 64, 0.0F);
  alignas(64) float alpha[64];
  const bool is_final = look_.model && !is_light(*look_.model);
  if (!ramps_.empty() && !is_final && seen_kernels(isa) != nullptr)
    color_all(frame, block, isa, surface, alpha);
  else
    color_each(frame, block, surface, alpha);
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
  const bool is_final = !is_light(*look_.model);
  const LitKernels* const lanes = lit_kernels(isa);
  if (!is_final && lanes != nullptr)
    return lanes->shade_base({*look_.model, &lit_}, frame, block, surface, colors);
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
          kept.find(lit_, frame, block.keys[i] & kIdMask, row_of(*look_.model).normal);
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
