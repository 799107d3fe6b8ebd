// The vertex stage of plain meshes: positions times one matrix.
#pragma once

#include <cmath>
#include <span>

#include <rastrum/core/mat.hpp>
#include <rastrum/raster/draws/geometry.hpp>

namespace rastrum::raster {

/// A position for the clipper: in float32, or for a finite vertex that overflows there in float64;
/// a NaN or infinity stays one.
[[nodiscard]] RASTRUM_HD inline Vec4d clip_position_of(Vec3 p, const Mat4& matrix,
                                                       const Mat4d& matrix64) {
  const Vec4 clip = transform_point(matrix, p);
  if (std::isfinite(clip.x) && std::isfinite(clip.y) && std::isfinite(clip.z) &&
      std::isfinite(clip.w))
    return {clip.x, clip.y, clip.z, clip.w};
  const auto row = [&](int i) {
    return matrix64.m[i][0] * p.x + matrix64.m[i][1] * p.y + matrix64.m[i][2] * p.z +
           matrix64.m[i][3];
  };
  return {row(0), row(1), row(2), row(3)};
}

/// Positions in object space and their matrix to clip space.
class TransformSource final : public VertexSource {
 public:
  TransformSource(std::span<const Vec3> positions, const Mat4d& object_to_clip)
      : positions_(positions), matrix64_(object_to_clip), matrix_(object_to_clip) {}

  void project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
               ProjectedVertex* out) const noexcept override;
  void project_indexed(std::span<const std::uint32_t> indices, Viewport viewport, Isa isa,
                       ProjectedVertex* out) const noexcept override;
  [[nodiscard]] Vec4d clip_position(std::size_t vertex) const noexcept override {
    return clip_position_of(positions_[vertex], matrix_, matrix64_);
  }
  [[nodiscard]] std::span<const Vec3> positions() const { return positions_; }
  [[nodiscard]] const Mat4d& object_to_clip() const { return matrix64_; }

 private:
  std::span<const Vec3> positions_;
  Mat4d matrix64_;
  Mat4 matrix_;
};

}  // namespace rastrum::raster
