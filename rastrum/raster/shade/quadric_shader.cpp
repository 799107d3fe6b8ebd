#include <rastrum/raster/shade/quadric_shader.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/material_scalar.hpp>

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

Vec4 color_at(const QuadricGeometry& geometry, const InstanceView& instance,
              std::uint64_t primitive, double along) {
  if (instance.color) return *instance.color;
  const ArrayView<Vec4> colors = colors_of(geometry, instance);
  if (colors.empty()) return {1, 1, 1, 1};
  const AxisEnds ends = axis_ends(geometry, primitive);
  return lerp(colors[ends.first], colors[ends.second], static_cast<float>(along));
}

/// A primitive as shading asks for it.
struct QuadricShader::Kept {
  std::uint64_t low = 0;  ///< of the key; 0: none yet
  const Surface* surface = nullptr;
  QuadricSurface quadric;
  Vec4 color[2];
};
/// Those that were seen last, by their ids' low bits.
struct QuadricShader::KeptQuadrics {
  static constexpr std::size_t kCount = 64;
  Kept kept[kCount];
};

void QuadricShader::add(const QuadricStage& stage, const InstanceView& instance) {
  const ArrayView<Vec4> colors = colors_of(stage.geometry(), instance);
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
  (void)out.quadric.find(stage, primitive, frame.viewport);
  const Vec4& base = out.surface->plain.base;
  out.color[0] = out.color[1] = base;
  const ArrayView<Vec4>& colors = out.surface->colors;
  if (colors.empty()) return;
  const AxisEnds ends = axis_ends(stage.geometry(), primitive);
  out.color[0] = colors[ends.first] * base;
  out.color[1] = colors[ends.second] * base;
}

Vec4 QuadricShader::color(const Kept& k, const FrameGeometry&, std::uint64_t key, float px,
                          float py, QuadricSurface::Place at) const {
  // Which of the two surfaces it is, its depth tells.
  const auto depth = std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits));
  scalar_wide::Surface s = k.quadric.side(false, at);
  if (!s.covered || quadric_depth(k.quadric.quadric, s.e) != depth) s = k.quadric.side(true, at);
  const QuadricPoint point = point_on(k.quadric.shape, k.quadric.point(at, s.e));
  const Vec4 base = lerp(k.color[0], k.color[1], static_cast<float>(point.along));
  const Vec3 normal = times(k.surface->plain.normal_matrix, Vec3(point.normal));
  return look_.shade(k.surface->plain, base, &normal, px, py, kIdMask - k.low);
}

std::uint64_t QuadricShader::test(const FrameGeometry& frame, const Piece& piece,
                                  const Block& block, const ShadingPoints* points) const noexcept {
  Kept k;
  fetch(frame, piece.low, k);
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
    opaque &= colors.set(
        i, color(kept, frame, key, static_cast<float>(x) + 0.5F + from_centre.x,
                 static_cast<float>(y) + 0.5F + from_centre.y, kept.quadric.at(x, y, from_centre)));
  }
  return opaque;
}

}  // namespace rastrum::raster
