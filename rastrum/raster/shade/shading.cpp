#include <rastrum/raster/shade/shading.hpp>

#include <algorithm>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>
#include <rastrum/raster/shade/seen_bin.hpp>

namespace rastrum::raster {

bool Shading::shade_colors(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                           BlockColors& colors) const noexcept {
  if (const LitShading* const l = lit()) {
    shade_lit_block(*l, frame, block, isa, colors);
    return true;
  }
  if (const MaterialShading* const m = material()) {
    material_kernels(isa).shade(m->scene->view(), frame, block, m->linear, nullptr, colors);
    return true;
  }
  return own()->shade(frame, block, isa, colors);
}

bool Shading::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                    BlockColors& colors) const noexcept {
  if (!has_alpha()) return shade_colors(frame, block, isa, colors);
  const MaterialKernels& kernel = material_kernels(isa);
  alignas(64) float alpha[64];
  AlphaMasks masks;
  if (blending_ != nullptr) {
    masks = kernel.alpha(blending_->view(), frame, block, opacity_, alpha);
  } else {
    std::fill_n(alpha, 64, opacity_);
    if (opacity_ > 0) masks.visible = block.covered;
  }
  if (masks.opaque == block.covered) return shade_colors(frame, block, isa, colors);
  if (masks.visible == 0) {
    colors = {};
    return false;
  }
  VisibleBlock visible = block;
  visible.covered = masks.visible;
  if (shade_colors(frame, visible, isa, colors)) std::fill_n(colors.a, 64, 1.0F);
  kernel.premultiply(alpha, colors);
  return false;
}

bool Shading::store(const FrameGeometry& frame, const VisibleBlock& block, Isa isa, Rgba8 empty,
                    BlockPixels to) const noexcept {
  const LitShading* const l = lit();
  return l != nullptr && !has_alpha() &&
         store_lit_simd(isa, l->model, *l->scene, frame, block, empty, to);
}

bool Shading::shade_runs(const FrameGeometry& frame, const FragmentRuns& runs, Isa isa,
                         Vec4* colors) const noexcept {
  const LitShading* const l = lit();
  return l != nullptr && blending_ == nullptr && opacity_ > 0 &&
         shade_lit_runs(isa, *l, frame, runs, opacity_, colors);
}

bool Shading::suits_bin(const BinSurface& bin, Isa isa) const noexcept {
  if (has_alpha()) return false;
  if (const MaterialShading* const m = material())
    return material_kernels(isa).see_bin != nullptr && !m->scene->bent && is_fine(bin);
  const LitShading* const l = lit();
  return l != nullptr && suits_lit_bin(isa, *l, bin);
}

void Shading::see_bin(const FrameGeometry& frame, const BinSurface& bin, int row, Isa isa,
                      SeenBin& own) const noexcept {
  if (const MaterialShading* const m = material())
    material_kernels(isa).see_bin(m->scene->view(), frame, bin, row, own);
  else
    see_lit_bin(isa, *lit(), frame, bin, row, own);
}

void Shading::prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept {
  if (const LitShading* const l = lit()) {
    if (l->model == LitModel::id) return;  // reads nothing
    prefetch_triangle(*l->scene, frame, id,
                      l->model != LitModel::flat && l->model != LitModel::wireframe);
  } else if (const BlockShader* const shader = own()) {
    shader->prefetch(frame, id);
  }
}

std::optional<float> Shading::alpha() const noexcept {
  const BlockShader* const shader = own();
  const std::optional<float> inner = shader == nullptr ? std::optional(1.0F) : shader->alpha();
  return inner && blending_ == nullptr ? std::optional(*inner * opacity_) : std::nullopt;
}

bool Shading::wants_depth() const noexcept {
  // Light from a direction does not ask where a surface lies.
  const auto asks = [](const LightSet* lights) { return lights != nullptr && lights->has_places; };
  if (const LitShading* const l = lit()) return asks(l->scene->lights);
  if (const MaterialShading* const m = material()) return asks(m->scene->lights);
  const BlockShader* const shader = own();
  return shader != nullptr && shader->wants_depth();
}

std::size_t Shading::scratch_bytes() const noexcept {
  if (lit() != nullptr) return sizeof(KeptTriangles);
  const BlockShader* const shader = own();
  return shader == nullptr ? 0 : shader->scratch_bytes();
}

std::size_t Shading::extra_count() const noexcept {
  const BlockShader* const shader = own();
  return shader == nullptr || has_alpha() ? 0 : shader->extra_count();
}

std::size_t Shading::Hash::operator()(const Shading& s) const noexcept {
  const void* const what = s.lit() != nullptr        ? static_cast<const void*>(s.lit()->scene)
                           : s.material() != nullptr ? s.material()->scene
                                                     : static_cast<const void*>(s.own());
  return std::hash<const void*>()(what);
}

std::uint64_t Testing::test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                            const ShadingPoints* points) const noexcept {
  if (const MaskTest* const m = masks())
    return material_kernels(frame.isa).alpha_test(m->scene->view(), frame, id_of_key(piece.low),
                                                  block.mask, block.bx * kBlockSize,
                                                  block.by * kBlockSize, points);
  const FragmentTest* const test = own();
  return test == nullptr ? block.mask : test->test(frame, piece, block, points);
}

}  // namespace rastrum::raster
