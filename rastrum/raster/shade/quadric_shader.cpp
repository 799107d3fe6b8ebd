// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/quadric_shader.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/shade/quadric_lanes.hpp>

namespace rastrum::raster {
namespace {

Vec4 lerp(const Vec4& a, const Vec4& b, float t) {
  return a * (1 - t) + b * t;
}

}  // namespace

ArrayView<Vec4> colors_of(const QuadricGeometry& geometry, const InstanceView& instance) {
  if (instance.color) return {};
  return std::visit([](const auto& g) { return g.colors; }, geometry);
}

Vec4 albedo_at(const QuadricGeometry& geometry, const InstanceView& instance,
               std::span<const Material> materials, std::uint64_t primitive, double along) {
  const auto light = [](Vec4 c) { return converted(c, ColorSpace::display, ColorSpace::linear); };
  const ArrayView<Vec4> colors = colors_of(geometry, instance);
  const bool colored = instance.color || !colors.empty();
  const Vec4 base =
      (materials.empty() ? plain_material(colored) : materials[material_of(instance)]).base_color;
  if (!colored) return base;
  if (instance.color) return base * light(*instance.color);
  const AxisEnds ends = axis_ends(geometry, primitive);
  return base *
         lerp(light(colors[ends.first]), light(colors[ends.second]), static_cast<float>(along));
}

struct QuadricShader::Kept {
  std::uint64_t low = 0;  ///< of the key; 0: none
  const Surface* surface = nullptr;
  QuadricSurface quadric;
  Vec4 color[2];
  double scalar[2] = {0, 0};  ///< at the ends of its axis, if shown
};
/// The last ones, by their ids' low bits.
struct QuadricShader::KeptQuadrics {
  static constexpr std::size_t kCount = 128;
  Kept kept[kCount];
  const QuadricStage* stage = nullptr;  ///< the last one
  std::optional<QuadricEye> eye;        ///< of `stage`

  const QuadricEye& eye_of(const QuadricStage& of, Viewport viewport) {
    if (stage != &of) eye.emplace(of, viewport);
    stage = &of;
    return *eye;
  }
};

QuadricShader::QuadricShader(const SurfaceLook& look, std::span<const Material> materials,
                             const Camera& camera, int width, int height)
    : look_(look, materials, camera, width, height) {}

void QuadricShader::add(const QuadricStage& stage, const InstanceView& instance,
                        const SurfaceScalars& scalars) {
  const bool shows = scalars.colors() != nullptr;
  const ArrayView<Vec4> colors = shows ? ArrayView<Vec4>{} : colors_of(stage.geometry(), instance);
  surfaces_.push_back({&stage, look_.surface(instance, !colors.empty()), colors, scalars});
  surfaces_.back().plain.own_alpha = shows;
}

std::size_t QuadricShader::scratch_bytes() const noexcept {
  return sizeof(KeptQuadrics);
}

void QuadricShader::fetch(const FrameGeometry& frame, std::uint64_t low, KeptQuadrics* all,
                          Kept& out) const {
  out.low = low;
  const std::uint64_t id = kIdMask - low;
  const Draw& draw = frame.draw_of(id);
  out.surface = &surfaces_[draw.number];
  const QuadricStage& stage = *out.surface->stage;
  const std::uint64_t primitive = id - draw.first_id;
  if (all != nullptr)
    (void)out.quadric.find(stage, primitive, all->eye_of(stage, frame.viewport));
  else
    (void)out.quadric.find(stage, primitive, frame.viewport);
  out.color[0] = out.color[1] = out.surface->plain.base;
  if (out.surface->shows_scalars())
    out.surface->scalars.at_ends(axis_ends(stage.geometry(), primitive), out.scalar);
  const ArrayView<Vec4>& colors = out.surface->colors;
  if (colors.empty()) return;
  const AxisEnds ends = axis_ends(stage.geometry(), primitive);
  const Vec4& base = out.surface->plain.base;
  out.color[0] = look_.shown(colors[ends.first], ColorSpace::display) * base;
  out.color[1] = look_.shown(colors[ends.second], ColorSpace::display) * base;
}

QuadricShader::Seen QuadricShader::seen(const Kept& k, std::uint64_t key,
                                        QuadricSurface::Place at) const {
  // The depth tells which of the two sides it is.
  const float depth = depth_of_key(key);
  scalar_wide::Surface s = k.quadric.side(false, at);
  if (!s.covered || quadric_depth(k.quadric.quadric, s.e) != depth) s = k.quadric.side(true, at);
  const RayFrame::Point h = k.quadric.point(at, s.e);
  const QuadricPoint point = point_on(k.quadric.shape, h);
  const Vec3 normal = times(k.surface->plain.normal_matrix, Vec3(point.normal));
  if (!k.surface->shows_scalars())
    return {lerp(k.color[0], k.color[1], static_cast<float>(point.along)), normal};
  const SurfaceScalars& scalars = k.surface->scalars;
  const double per_px = scalars.colors()->has_isolines() ? k.quadric.along_per_px(h, point) : 0;
  return {scalars.color(k.scalar, point.along, per_px, look_.look().is_linear()), normal};
}

std::uint64_t QuadricShader::test(const FrameGeometry& frame, const Piece& piece,
                                  const Block& block, const ShadingPoints* points) const noexcept {
  Kept k;
  fetch(frame, piece.low, nullptr, k);
  if (k.surface->shows_scalars()) return block.mask;  // scalars have no holes
  const bool away = (piece.flags & kFacesAway) != 0;
  std::uint64_t kept = 0;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const Vec2 from_centre = points == nullptr ? Vec2{0, 0} : Vec2{points->dx[i], points->dy[i]};
    const QuadricSurface::Place at =
        k.quadric.at(block.bx * kBlockSize + i % kBlockSize, block.by * kBlockSize + i / kBlockSize,
                     from_centre);
    const RayFrame::Point h = k.quadric.point(at, k.quadric.side(away, at).e);
    const auto along = static_cast<float>(point_on(k.quadric.shape, h).along);
    const float alpha = lerp(k.color[0], k.color[1], along).w;
    kept |= std::uint64_t{!(alpha < k.surface->plain.material->alpha_cutoff)} << i;
  }
  return kept;
}

void QuadricShader::fill(const QuadricLanes& lanes, const Kept& kept, const VisibleBlock& block,
                         std::uint64_t mask, QuadricBlock& out) const {
  const QuadricKind kind = kept.quadric.shape.kind;
  if (block.points == nullptr && !kept.surface->shows_scalars() &&
      (kind == QuadricKind::sphere || kind == QuadricKind::hull))
    return lanes.fill(kept.quadric, kept.surface->plain.normal_matrix, kept.color, block, mask,
                      out);
  for (; mask != 0; mask &= mask - 1) {
    const int i = std::countr_zero(mask);
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    const Seen s =
        seen(kept, block.keys[i],
             kept.quadric.at(block.x0 + i % kBlockSize, block.y0 + i / kBlockSize, from_centre));
    const float n[3] = {s.normal.x, s.normal.y, s.normal.z};
    const float base[3] = {s.base.x, s.base.y, s.base.z};
    for (int k = 0; k < 3; ++k) {
      out.lit.n[k][i] = n[k];
      out.lit.base[k][i] = base[k];
    }
    out.alpha[i] = s.base.w;
  }
}

bool QuadricShader::shade_lit(const QuadricLanes& lanes, const FrameGeometry& frame,
                              const VisibleBlock& block, Isa isa, BlockColors& colors) const {
  KeptQuadrics& all = *static_cast<KeptQuadrics*>(block.scratch);
  const bool blends = look_.look().blends;
  QuadricBlock surface;
  for (std::uint64_t rest = block.covered; rest != 0;) {
    const std::uint64_t low = block.keys[std::countr_zero(rest)] & kIdMask;
    const std::uint64_t same = lanes.samples_of(block.keys, low) & rest;
    rest &= ~same;
    Kept& kept = all.kept[low % KeptQuadrics::kCount];
    if (kept.low != low) fetch(frame, low, &all, kept);
    fill(lanes, kept, block, same, surface);
    if (!blends) continue;
    for (std::uint64_t m = same; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      surface.alpha[i] = look_.alpha(kept.surface->plain, surface.alpha[i]);
    }
  }
  lit_kernels(isa)->light(*look_.look().model, look_.rays(), look_.look().lights, block,
                          surface.lit, colors);
  if (!blends) return true;
  bool opaque = true;
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const float a = surface.alpha[i];
    opaque &= colors.set(i, {colors.r[i] * a, colors.g[i] * a, colors.b[i] * a, a});
  }
  return opaque;
}

bool QuadricShader::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                          BlockColors& colors) const noexcept {
  const auto& model = look_.look().model;
  const QuadricLanes* const lanes = quadric_lanes(isa);
  if (lanes != nullptr && model && is_light(*model))
    return shade_lit(*lanes, frame, block, isa, colors);
  bool opaque = true;
  KeptQuadrics& all = *static_cast<KeptQuadrics*>(block.scratch);
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t key = block.keys[i];
    const std::uint64_t low = key & kIdMask, id = kIdMask - low;
    if (model == Shader::id) {
      const Surface& surface = surfaces_[frame.draw_of(id).number];
      if (!look_.look().blends || !surface.has_own_alpha()) {
        opaque &= colors.set(i, look_.shade(surface.plain, {0, 0, 0, 1}, nullptr, 0, 0, key));
        continue;
      }
    }
    Kept& kept = all.kept[low % KeptQuadrics::kCount];
    if (kept.low != low) fetch(frame, low, &all, kept);
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    const int x = block.x0 + i % kBlockSize, y = block.y0 + i / kBlockSize;
    const Seen s = seen(kept, key, kept.quadric.at(x, y, from_centre));
    opaque &= colors.set(i, look_.shade(kept.surface->plain, s.base, &s.normal,
                                        static_cast<float>(x) + 0.5F + from_centre.x,
                                        static_cast<float>(y) + 0.5F + from_centre.y, key));
  }
  return opaque;
}

}  // namespace rastrum::raster
