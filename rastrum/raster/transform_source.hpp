// The vertex stage of plain meshes: positions times one matrix.
#pragma once

#include <span>

#include <rastrum/core/mat.hpp>
#include <rastrum/raster/geometry.hpp>

namespace rastrum::raster {

/// Positions in object space and their matrix to clip space.
class TransformSource final : public VertexSource {
 public:
  TransformSource(std::span<const Vec3> positions, const Mat4d& object_to_clip)
      : positions_(positions), matrix64_(object_to_clip), matrix_(object_to_clip) {}

  void project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
               ProjectedVertex* out) const noexcept override;
  void project_indexed(std::span<const std::uint32_t> indices, Viewport viewport, Isa isa,
                       ProjectedVertex* out) const noexcept override;
  [[nodiscard]] Vec4d clip_position(std::size_t vertex) const noexcept override;

 private:
  std::span<const Vec3> positions_;
  Mat4d matrix64_;
  Mat4 matrix_;
};

}  // namespace rastrum::raster
