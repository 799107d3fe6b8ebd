// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/point_line_shader.hpp>

#include <bit>

#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/shade/normals.hpp>

namespace rastrum::raster {

Vec4 PointLineShader::color(const Part& part, Way way, std::uint32_t vertex) const {
  const Vec4& base = way == Way::albedo ? part.surface.albedo : part.surface.base;
  if (part.colors.empty()) return base;
  const Vec4 c = part.colors[vertex];
  return (way == Way::albedo ? converted(c, part.color_space, ColorSpace::linear)
                             : look_.shown(c, part.color_space)) *
         base;
}

ArrayView<Vec4> PointLineShader::add(const InstanceView& instance, const SurfaceScalars& scalars) {
  Part& part = parts_.emplace_back();
  part.scalars = scalars;
  if (const auto* const points = instance.geometry.get_if<PointsView>()) {
    part.colors = points->colors;
    part.color_space = points->color_space;
    part.normals = points->normals;
  } else {
    const auto& lines = *instance.geometry.get_if<LinesView>();
    part.colors = lines.colors;
    part.color_space = lines.color_space;
  }
  if (instance.color || scalars.colors() != nullptr) part.colors = {};
  part.surface = look_.surface(instance, !part.colors.empty());
  part.surface.own_alpha = scalars.colors() != nullptr;
  return part.colors;
}

Vec4 PointLineShader::along(const Part& part, Way way, const Fragment& f) const {
  const Vec4 first = color(part, way, f.vertex[0]);
  if (part.colors.empty()) return first;
  // Exactly the first if both are equal.
  const Vec4 change = color(part, way, f.vertex[1]) + first * -1;
  return first + change * static_cast<float>(f.weights.b[1]);
}

void PointLineShader::prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept {
  const Draw& draw = frame.draw_of(id);
  const Part& part = part_of(draw);
  if (part.colors.empty() && part.normals.empty()) return;
  const std::uint32_t v = draw.vertex(id - draw.first_id, 0);
  if (!part.colors.empty()) __builtin_prefetch(part.colors.address(v));
  if (!part.normals.empty()) __builtin_prefetch(part.normals.address(v));
}

bool PointLineShader::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa,
                            BlockColors& colors) const noexcept {
  // Neighbours on the screen lie anywhere in memory.
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1)
    prefetch(frame, id_of_key(block.keys[std::countr_zero(m)]));
  FragmentLocator locator(frame);
  bool opaque = true;
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    const Draw& draw = frame.draw_of(id);
    const Part& part = part_of(draw);
    Vec4 base;
    Vec3 normal;
    if (part.scalars.colors() != nullptr) {
      const Fragment& f = locator.locate(id, block.x0, block.y0, i, block.points);
      base = part.scalars.color(f, draw.topology, look_.look().is_linear());
    } else if (draw.topology == Topology::lines) {
      base = along(part, Way::shown, locator.locate(id, block.x0, block.y0, i, block.points));
    } else {
      const std::uint32_t v = draw.vertex(id - draw.first_id, 0);
      base = color(part, Way::shown, v);
    }
    if (!part.normals.empty())
      normal = times(part.surface.normal_matrix,
                     safe_normal(part.normals[draw.vertex(id - draw.first_id, 0)]));
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    const float px = static_cast<float>(block.x0 + i % kBlockSize) + 0.5F + from_centre.x;
    const float py = static_cast<float>(block.y0 + i / kBlockSize) + 0.5F + from_centre.y;
    const bool is_lit = normal.x != 0 || normal.y != 0 || normal.z != 0;
    opaque &= colors.set(
        i, look_.shade(part.surface, base, is_lit ? &normal : nullptr, px, py, block.keys[i]));
  }
  return opaque;
}

std::uint64_t PointLineShader::test(const FrameGeometry& frame, const Piece& piece,
                                    const Block& block,
                                    const ShadingPoints* points) const noexcept {
  const std::uint64_t id = id_of_key(piece.low);
  const Draw& draw = frame.draw_of(id);
  const Part& part = part_of(draw);
  if (part.scalars.colors() != nullptr) return block.mask;  // scalars have no holes
  const float cutoff = part.surface.material->alpha_cutoff;
  if (draw.topology == Topology::points || part.colors.empty()) {
    const std::uint32_t v = draw.vertex(id - draw.first_id, 0);
    return color(part, Way::shown, v).w < cutoff ? 0 : block.mask;
  }
  FragmentLocator locator(frame);
  std::uint64_t kept = block.mask;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const Fragment& f = locator.locate(id, block.bx * kBlockSize, block.by * kBlockSize, i, points);
    if (along(part, Way::shown, f).w < cutoff) kept ^= std::uint64_t{1} << i;
  }
  return kept;
}

Vec4 PointLineShader::albedo(const FrameGeometry& frame, const Fragment& f) const {
  const Draw& draw = frame.draws[f.draw];
  const Part& part = part_of(draw);
  return draw.topology == Topology::lines ? along(part, Way::albedo, f)
                                          : color(part, Way::albedo, f.vertex[0]);
}

}  // namespace rastrum::raster
