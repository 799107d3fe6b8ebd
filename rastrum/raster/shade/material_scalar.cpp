// SPDX-License-Identifier: BSD-3-Clause
// Materials over blocks on the host, fragment by fragment: the plain form that the lanes must
// equal. Devices have the same form.
#include <rastrum/raster/shade/material_scalar.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/raster/shade/material_kernels.hpp>

namespace rastrum::raster {
namespace {

template <class F>
void for_each_sample(std::uint64_t mask, int x0, int y0, const ShadingPoints* points, F&& f) {
  for (; mask != 0; mask &= mask - 1) {
    const int i = std::countr_zero(mask);
    f(i, x0 + i % kBlockSize, y0 + i / kBlockSize,
      points == nullptr ? Vec2{0, 0} : Vec2{points->dx[i], points->dy[i]});
  }
}

void shade(const MaterialView& scene, const FrameGeometry& frame, const VisibleBlock& block,
           bool linear, const float* own_base, BlockColors& colors) noexcept {
  for_each_sample(
      block.covered, block.x0, block.y0, block.points, [&](int i, int x, int y, Vec2 from_centre) {
        const std::uint64_t id = id_of_key(block.keys[i]);
        const MaterialTriangle t(scene, frame, frame.draw_of(id), id);
        const Vec3 base =
            own_base == nullptr ? Vec3{} : Vec3{own_base[i], own_base[64 + i], own_base[128 + i]};
        const Vec3 c =
            shade_material(scene, t, MaterialPoint(t.planes, x, y, from_centre), linear,
                           depth_of_key(block.keys[i]), own_base == nullptr ? nullptr : &base);
        colors.set(i, {c.x, c.y, c.z, 1});
      });
}

std::uint64_t alpha_test(const MaterialView& scene, const FrameGeometry& frame, std::uint64_t id,
                         std::uint64_t mask, int x0, int y0, const ShadingPoints* points) noexcept {
  std::uint64_t kept = 0;
  for_each_sample(mask, x0, y0, points, [&](int i, int x, int y, Vec2 from_centre) {
    kept |= std::uint64_t{passes_mask(scene, frame, id, x, y, from_centre)} << i;
  });
  return kept;
}

AlphaMasks alpha(const MaterialView& scene, const FrameGeometry& frame, const VisibleBlock& block,
                 float opacity, float* out) noexcept {
  AlphaMasks masks;
  std::fill_n(out, 64, 0.0F);
  for_each_sample(
      block.covered, block.x0, block.y0, block.points, [&](int i, int x, int y, Vec2 from_centre) {
        const float a =
            alpha_at(scene, frame, id_of_key(block.keys[i]), x, y, from_centre, opacity);
        out[i] = a;
        masks.visible |= std::uint64_t{a > 0} << i;
        masks.opaque |= std::uint64_t{a == 1} << i;
      });
  return masks;
}

void premultiply(const float* alpha, BlockColors& colors) noexcept {
  for (float* const channel : {colors.r, colors.g, colors.b, colors.a})
    for (int i = 0; i < 64; ++i) channel[i] = alpha[i] > 0 ? channel[i] * alpha[i] : 0.0F;
}

}  // namespace

const MaterialKernels& scalar_material_kernels() noexcept {
  static constexpr MaterialKernels kTable{shade, alpha_test, alpha, premultiply, nullptr};
  return kTable;
}

}  // namespace rastrum::raster
