// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/shader.hpp>

#include <algorithm>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/shade/light_set.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/shade/material_kernels.hpp>

namespace rastrum::raster {

namespace {

/// Not multiplied by the alpha of `shading`.
bool shade_colors(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                  Isa isa, BlockColors& colors) noexcept {
  if (const LitShading* const l = shading.lit()) {
    shade_lit_block(*l, frame, block, isa, colors);
    return true;
  }
  if (const MaterialShading* const m = shading.material()) {
    material_kernels(isa).shade(m->scene->view(), frame, block, m->linear, nullptr, colors);
    return true;
  }
  return shading.own()->shade(frame, block, isa, colors);
}

}  // namespace

bool shade_block(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                 Isa isa, BlockColors& colors) noexcept {
  if (!shading.has_alpha()) return shade_colors(shading, frame, block, isa, colors);
  const MaterialKernels& kernel = material_kernels(isa);
  alignas(64) float alpha[64];
  AlphaMasks masks;
  if (shading.blending() != nullptr) {
    masks = kernel.alpha(shading.blending()->view(), frame, block, shading.opacity(), alpha);
  } else {
    std::fill_n(alpha, 64, shading.opacity());
    if (shading.opacity() > 0) masks.visible = block.covered;
  }
  if (masks.opaque == block.covered) return shade_colors(shading, frame, block, isa, colors);
  if (masks.visible == 0) {
    colors = {};
    return false;
  }
  VisibleBlock visible = block;
  visible.covered = masks.visible;
  if (shade_colors(shading, frame, visible, isa, colors)) std::fill_n(colors.a, 64, 1.0F);
  kernel.premultiply(alpha, colors);
  return false;
}

bool store_shaded(const Shading& shading, const FrameGeometry& frame, const VisibleBlock& block,
                  Isa isa, Rgba8 empty, BlockPixels to) noexcept {
  const LitShading* const l = shading.lit();
  const LitKernels* const lanes = lit_kernels(isa);
  if (l == nullptr || lanes == nullptr || !is_light(l->model) || shading.has_alpha()) return false;
  lanes->store(*l, frame, block, empty, to);
  return true;
}

bool shade_runs(const Shading& shading, const FrameGeometry& frame, const FragmentRuns& runs,
                Isa isa, Vec4* colors) noexcept {
  const LitShading* const l = shading.lit();
  const LitKernels* const lanes = lit_kernels(isa);
  if (l == nullptr || lanes == nullptr || !is_light(l->model) || shading.blending() != nullptr ||
      !(shading.opacity() > 0))
    return false;
  lanes->shade_runs(*l, frame, runs, shading.opacity(), colors);
  return true;
}

bool suits_bin(const Shading& shading, const BinSurface& bin, Isa isa) noexcept {
  if (shading.has_alpha()) return false;
  if (const MaterialShading* const m = shading.material())
    return material_kernels(isa).see_bin != nullptr && !m->scene->bent && is_fine(bin);
  const LitShading* const l = shading.lit();
  if (l == nullptr || lit_kernels(isa) == nullptr) return false;
  const ShaderRow& row = row_of(l->model);
  return (row.normal || (row.base && l->scene->colored)) && is_fine(bin);
}

void see_bin(const Shading& shading, const FrameGeometry& frame, const BinSurface& bin, int row,
             Isa isa, SeenBin& seen) noexcept {
  if (const MaterialShading* const m = shading.material())
    material_kernels(isa).see_bin(m->scene->view(), frame, bin, row, seen);
  else
    lit_kernels(isa)->see_bin(*shading.lit(), frame, bin, row, seen);
}

void prefetch(const Shading& shading, const FrameGeometry& frame, std::uint64_t id) noexcept {
  if (const LitShading* const l = shading.lit()) {
    if (l->model == Shader::id) return;  // reads nothing
    prefetch_triangle(*l->scene, frame, id, row_of(l->model).normal);
  } else if (const BlockShader* const shader = shading.own()) {
    shader->prefetch(frame, id);
  }
}

std::optional<float> constant_alpha(const Shading& shading) noexcept {
  const BlockShader* const shader = shading.own();
  const std::optional<float> inner = shader == nullptr ? std::optional(1.0F) : shader->alpha();
  return inner && shading.blending() == nullptr ? std::optional(*inner * shading.opacity())
                                                : std::nullopt;
}

bool wants_depth(const Shading& shading) noexcept {
  // Light with a direction does not depend on a surface's place.
  const auto asks = [](const LightSet* lights) { return lights != nullptr && lights->has_places; };
  if (const LitShading* const l = shading.lit()) return asks(l->scene->lights);
  if (const MaterialShading* const m = shading.material()) return asks(m->scene->lights);
  const BlockShader* const shader = shading.own();
  return shader != nullptr && shader->wants_depth();
}

std::size_t scratch_bytes(const Shading& shading) noexcept {
  if (shading.lit() != nullptr) return sizeof(KeptTriangles);
  const BlockShader* const shader = shading.own();
  return shader == nullptr ? 0 : shader->scratch_bytes();
}

std::size_t extra_count(const Shading& shading) noexcept {
  const BlockShader* const shader = shading.own();
  return shader == nullptr || shading.has_alpha() ? 0 : shader->extra_count();
}

std::uint64_t test_block(const Testing& testing, const FrameGeometry& frame, const Piece& piece,
                         const Block& block, const ShadingPoints* points) noexcept {
  if (const MaskTest* const m = testing.masks())
    return material_kernels(frame.isa).alpha_test(m->scene->view(), frame, id_of_key(piece.low),
                                                  block.mask, block.bx * kBlockSize,
                                                  block.by * kBlockSize, points);
  const FragmentTest* const test = testing.own();
  return test == nullptr ? block.mask : test->test(frame, piece, block, points);
}

}  // namespace rastrum::raster
