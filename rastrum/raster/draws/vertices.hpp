// SPDX-License-Identifier: BSD-3-Clause
// The vertex stage of a draw, a value for host and device: positions under a matrix, or a caller's
// function.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include <rastrum/array.hpp>
#include <rastrum/core/float32.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/raster/rules/clip.hpp>
#include <rastrum/raster/rules/projection.hpp>

namespace rastrum::raster {

/// A vertex stage of the caller's own. Thread-safe.
class VertexSource {
 public:
  virtual ~VertexSource() = default;
  /// Projects vertices [begin, end) into out[0 … end − begin).
  virtual void project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
                       ProjectedVertex* out) const noexcept = 0;
  /// Homogeneous, for the clipper; NaN if the vertex is not finite.
  [[nodiscard]] virtual Vec4d clip_position(std::size_t vertex) const noexcept = 0;
};

/// A position for the clipper, in float32, or in float64 for a finite vertex that overflows there.
/// A NaN or infinity stays one.
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

/// From a float64 position: transformed in float64 and rounded once.
[[nodiscard]] inline Vec4d clip_position_of(Vec3d p, const Mat4d& matrix64) {
  const Vec4d exact = transform_point(matrix64, p);
  const Vec4d clip = {in_float32(exact.x), in_float32(exact.y), in_float32(exact.z),
                      in_float32(exact.w)};
  if (std::isfinite(clip.x) && std::isfinite(clip.y) && std::isfinite(clip.z) &&
      std::isfinite(clip.w))
    return clip;
  return exact;
}

/// Positions in object space, which must outlive the frame, and the matrix to clip space.
struct MatrixVertices {
  ArrayView<Vec3> positions;
  Mat4d object_to_clip;
  Mat4 object_to_clip32;  ///< the same, rounded

  MatrixVertices(const ArrayView<Vec3>& p, const Mat4d& to_clip)
      : positions(p), object_to_clip(to_clip), object_to_clip32(to_clip) {}
};

/// Positions under one matrix after the other: vertex v of copy k is number k · positions.size() +
/// v.
struct CopiedVertices {
  ArrayView<Vec3> positions;
  const Mat4d* object_to_world;  ///< of copy 0
  std::size_t stride_bytes;      ///< between copies
  Mat4d world_to_clip;

  [[nodiscard]] MatrixVertices copy(std::size_t k) const {
    const auto* const bytes =
        static_cast<const std::byte*>(static_cast<const void*>(object_to_world));
    const void* const own = bytes + k * stride_bytes;
    return {positions, world_to_clip * *static_cast<const Mat4d*>(own)};
  }
};

class VertexStage {
 public:
  VertexStage() = default;  ///< none
  VertexStage(const MatrixVertices& vertices) : stage_(vertices) {}
  VertexStage(const CopiedVertices& vertices) : stage_(vertices) {}
  /// The caller's, which must outlive the frame; null: none.
  VertexStage(const VertexSource* own) {
    if (own != nullptr) stage_ = own;
  }

  [[nodiscard]] explicit operator bool() const { return stage_.index() != 0; }
  /// Whether vertices are positions under matrices.
  [[nodiscard]] bool has_positions() const { return matrix() != nullptr || copies() != nullptr; }
  /// A device can read them. Null: only the host can make the vertices.
  [[nodiscard]] const MatrixVertices* matrix() const {
    return std::get_if<MatrixVertices>(&stage_);
  }

  /// Requires has_positions().
  [[nodiscard]] MatrixVertices matrix_of(std::uint64_t copy) const {
    const MatrixVertices* const m = matrix();
    return m != nullptr ? *m : copies()->copy(copy);
  }

  /// Projects vertices [begin, end) into out[0 … end − begin). Thread-safe, as are the others.
  void project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
               ProjectedVertex* out) const noexcept;
  /// Projects vertices `indices` into out[0 … size).
  void project_indexed(std::span<const std::uint32_t> indices, Viewport viewport, Isa isa,
                       ProjectedVertex* out) const noexcept;
  [[nodiscard]] Vec4d clip_position(std::size_t vertex) const noexcept {
    if (const MatrixVertices* const m = matrix()) return clip_position(*m, vertex);
    if (const CopiedVertices* const c = copies()) {
      const std::size_t n = c->positions.size();
      return clip_position(c->copy(vertex / n), vertex % n);
    }
    return own().clip_position(vertex);
  }

 private:
  [[nodiscard]] static Vec4d clip_position(const MatrixVertices& m, std::size_t vertex) {
    return m.positions.is_wide()
               ? clip_position_of(m.positions.wide(vertex), m.object_to_clip)
               : clip_position_of(m.positions[vertex], m.object_to_clip32, m.object_to_clip);
  }
  [[nodiscard]] const CopiedVertices* copies() const {
    return std::get_if<CopiedVertices>(&stage_);
  }
  [[nodiscard]] const VertexSource& own() const {
    return **std::get_if<const VertexSource*>(&stage_);
  }

  std::variant<std::monostate, MatrixVertices, CopiedVertices, const VertexSource*> stage_;
};

}  // namespace rastrum::raster
