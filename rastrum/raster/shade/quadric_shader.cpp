#include <rastrum/raster/shade/quadric_shader.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/setup/quadric.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_scalar.hpp>

namespace rastrum::raster {
namespace {

Vec3d unit_or(Vec3d v, Vec3d otherwise) {
  const double n = length(v);
  return n > 0 ? v * (1 / n) : otherwise;
}

/// The ends of a primitive among the geometry's colours.
struct ColorEnds {
  std::size_t first, second;
};
ColorEnds color_ends(const QuadricGeometry& geometry, std::uint64_t primitive) {
  const auto k = static_cast<std::size_t>(primitive);
  if (const auto* const c = std::get_if<CylindersView>(&geometry))
    return {c->end(primitive, 0), c->end(primitive, 1)};
  if (const auto* const t = std::get_if<TubesView>(&geometry)) {
    const std::size_t begin = t->begin(primitive);
    return {begin, begin + 1};
  }
  return {k, k};
}

Vec4 lerp(const Vec4& a, const Vec4& b, float t) {
  return a * (1 - t) + b * t;
}

}  // namespace

std::span<const Vec4> colors_of(const QuadricGeometry& geometry, const InstanceView& instance) {
  if (instance.color) return {};
  return std::visit([](const auto& g) { return g.colors; }, geometry);
}

QuadricPoint point_on(const QuadricShape& shape, const RayFrame::Point& h) {
  const Vec3d p = (h.v - shape.p0 * h.w) * (1 / h.w);  // from p0
  if (shape.kind == QuadricKind::disc) return {shape.p1, 0};
  if (shape.kind == QuadricKind::sphere) return {unit_or(p, {0, 0, 1}), 0};
  const Vec3d between = shape.p1 - shape.p0;
  const double distance = length(between);
  const Vec3d axis = between * (1 / distance);
  const double t = dot(p, axis);
  const Vec3d across = p - axis * t;
  const double radius = length(across);
  const Vec3d outwards = unit_or(across, {0, 0, 0});
  if (shape.kind == QuadricKind::hull) {
    const double sine = (shape.r0 - shape.r1) / distance;
    const double cosine = std::sqrt((1 - sine) * (1 + sine));
    // Where the cone's normal at the point meets the axis.
    const double foot = t - radius * sine / cosine;
    if (foot <= 0) return {unit_or(p, axis * -1), 0};
    if (foot >= distance) return {unit_or(p - between, axis), 1};
    return {outwards * cosine + axis * sine, foot / distance};
  }
  const double slope = (shape.r1 - shape.r0) / distance;
  const double along = std::clamp(t / distance, 0.0, 1.0);
  const double off_side = std::abs(radius - (shape.r0 + slope * t)) / std::sqrt(1 + slope * slope);
  if (shape.kind == QuadricKind::cone && std::min(std::abs(t), std::abs(distance - t)) < off_side)
    return {axis * (t < 0.5 * distance ? -1.0 : 1.0), along};
  return {unit_or(outwards - axis * slope, axis), along};
}

/// A primitive as shading asks for it.
struct QuadricShader::Kept {
  std::uint64_t low = 0;  ///< of the key; 0: none yet
  const Surface* surface = nullptr;
  QuadricShape shape;
  RayFrame rays;
  Quadric quadric;
  Piece piece;
  Vec4 color[2];
};
/// Those that were seen last, by their ids' low bits.
struct QuadricShader::KeptQuadrics {
  static constexpr std::size_t kCount = 64;
  Kept kept[kCount];
};

void QuadricShader::add(const QuadricStage& stage, const InstanceView& instance) {
  const std::span<const Vec4> colors = colors_of(stage.geometry(), instance);
  surfaces_.push_back({&stage, colors, look_.surface(instance, !colors.empty())});
}

std::size_t QuadricShader::scratch_bytes() const noexcept {
  return sizeof(KeptQuadrics);
}

void QuadricShader::fetch(const FrameGeometry& frame, std::uint64_t low, Kept& out) const {
  out.low = low;
  const std::uint64_t id = kIdMask - low;
  const Draw& draw = frame.draw_of(id);
  out.surface = &surfaces_[draw.number];
  const QuadricStage& stage = *out.surface->stage;
  const std::uint64_t primitive = id - draw.first_id;
  QuadricPlace place;
  (void)stage.shape(primitive, out.shape);
  (void)make_quadric({stage, frame.viewport}, out.shape, out.quadric, place, &out.rays);
  std::copy_n(place.x, 3, out.piece.x);
  std::copy_n(place.y, 3, out.piece.y);
  const Vec4& base = out.surface->plain.base;
  out.color[0] = out.color[1] = base;
  const std::span<const Vec4> colors = out.surface->colors;
  if (colors.empty()) return;
  const ColorEnds ends = color_ends(stage.geometry(), primitive);
  out.color[0] = colors[ends.first] * base;
  out.color[1] = colors[ends.second] * base;
}

Vec4 QuadricShader::color(const Kept& k, const FrameGeometry&, std::uint64_t key, float px,
                          float py, double dx, double dy) const {
  const Quadric& q = k.quadric;
  // Which of the two surfaces it is, its depth tells.
  const auto depth = std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits));
  const scalar_wide::QuadricRow row(q, dy);
  scalar_wide::Surface s = scalar_wide::surface_at(q, row, false, dx);
  if (!s.covered || quadric_depth(q, s.e) != depth) s = scalar_wide::surface_at(q, row, true, dx);
  const RayFrame& r = k.rays;
  const RayFrame::Point h{((r.o.v + r.x.v * dx) + r.y.v * dy) + r.depth.v * s.e,
                          ((r.o.w + r.x.w * dx) + r.y.w * dy) + r.depth.w * s.e};
  const QuadricPoint point = point_on(k.shape, h);
  const Vec4 base = lerp(k.color[0], k.color[1], static_cast<float>(point.along));
  const Vec3 normal = times(k.surface->plain.normal_matrix, Vec3(point.normal));
  return look_.shade(k.surface->plain, base, &normal, px, py, kIdMask - k.low);
}

bool QuadricShader::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa,
                          BlockColors& colors) const noexcept {
  bool opaque = true;
  KeptQuadrics& all = *static_cast<KeptQuadrics*>(block.scratch);
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t key = block.keys[i];
    const std::uint64_t low = key & kIdMask;
    if (look_.look().model == LitModel::id && !look_.look().blends) {
      const Vec3 c = id_color(kIdMask - low);
      colors.set(i, {c.x, c.y, c.z, 1});
      continue;
    }
    Kept& kept = all.kept[low % KeptQuadrics::kCount];
    if (kept.low != low) fetch(frame, low, kept);
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    const int x = block.x0 + i % kBlockSize, y = block.y0 + i / kBlockSize;
    constexpr double kPx = 1.0 / kSubpixels;
    const double dx = (x + 0.5 + static_cast<double>(from_centre.x)) - kept.piece.x[0] * kPx;
    const double dy = (y + 0.5 + static_cast<double>(from_centre.y)) - kept.piece.y[0] * kPx;
    opaque &= colors.set(i, color(kept, frame, key, static_cast<float>(x) + 0.5F + from_centre.x,
                                  static_cast<float>(y) + 0.5F + from_centre.y, dx, dy));
  }
  return opaque;
}

}  // namespace rastrum::raster
