// SPDX-License-Identifier: BSD-3-Clause
// The draws of a frame in device memory: the geometry for assemble.hpp. Spans name arrays that a
// user already has on the device, without copies (DeviceDraw). upload() (upload.cuh) makes the same
// of a host's draws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/vertices.hpp>

/// For large functions that many kernels call. Inlined, nvcc would compile them for minutes in each
/// kernel. A GPU has to show what the calls cost.
#define RASTRUM_HD_CALL RASTRUM_HD inline __attribute__((noinline))

namespace rastrum::raster {

/// A draw's vertex stage, in spans of device memory.
struct DeviceVertices {
  std::span<const Vec3> positions;  ///< object space
  Mat4d object_to_clip;
  /// The host's results for a stage that only it can run; then there are no positions.
  std::span<const Vec4d> clip;                 ///< VertexStage::clip_position of each
  std::span<const ProjectedVertex> projected;  ///< else DeviceScene's; empty: projected where read

  [[nodiscard]] RASTRUM_HD ProjectedVertex vertex(const Mat4& matrix, Viewport viewport,
                                                  std::uint32_t i) const {
    if (!projected.empty()) return projected[i];
    return project(transform_point(matrix, positions[i]), viewport);
  }
  [[nodiscard]] RASTRUM_HD Vec4d clip_position(const Mat4& matrix, std::uint32_t i) const {
    return positions.empty() ? clip[i] : clip_position_of(positions[i], matrix, object_to_clip);
  }
};

/// A draw with indices, face materials and flags by material on the device. Its `source` is not
/// read. DeviceScene numbers ids and vertex places.
struct DeviceDraw {
  Draw draw;
  DeviceVertices vertices;
};

/// A FrameGeometry for kernels. Borrows from a DeviceScene.
struct DeviceGeometry {
  int width = 0, height = 0;
  Viewport viewport;
  std::span<const Draw> draws;
  std::span<const DeviceVertices> vertices;  ///< of each draw
  std::span<const Mat4> matrices;            ///< of each draw, float32

  [[nodiscard]] RASTRUM_HD std::size_t number_of(const Draw& draw) const {
    return static_cast<std::size_t>(&draw - draws.data());
  }
  [[nodiscard]] RASTRUM_HD ProjectedVertex vertex(const Draw& draw, std::uint32_t index) const {
    const std::size_t d = number_of(draw);
    return vertices[d].vertex(matrices[d], viewport, index);
  }
  [[nodiscard]] RASTRUM_HD Vec4d clip_position(const Draw& draw, std::uint32_t index) const {
    const std::size_t d = number_of(draw);
    return vertices[d].clip_position(matrices[d], index);
  }
  /// Only the host has clip planes.
  [[nodiscard]] RASTRUM_HD std::uint32_t flags_of(const Draw& draw, std::uint64_t primitive) const {
    return draw.flags_of(primitive);
  }
  [[nodiscard]] RASTRUM_HD const Draw& draw_of(std::uint64_t id) const {
    return draw_with(draws, id);
  }
};

namespace cuda_detail {

/// Outside of its user, because nvcc's host code needs that.
struct ProjectVertex {
  Mat4 object_to_clip;
  Viewport viewport;
  RASTRUM_HD ProjectedVertex operator()(Vec3 p) const {
    return project(transform_point(object_to_clip, p), viewport);
  }
};

}  // namespace cuda_detail

template <class Exec>
class DeviceScene {
  template <class T>
  using Array = decltype(parallel::make_buffer<T>(std::declval<Exec&>(), 0));

 public:
  /// `draws`: a host list with spans of the device's, which must outlive this. Ids count from
  /// `first_id`. With `project_first` vertices are projected once, 16 B each, else where they are
  /// read. Throws Error{invalid_argument}: more primitives than ids. Work O(vertices + draws).
  DeviceScene(Exec& exec, std::span<const DeviceDraw> draws, int width, int height,
              std::uint64_t first_id = 0, bool project_first = true)
      : first_id_(first_id), width_(width), height_(height) {
    std::vector<Draw> numbered;
    std::vector<DeviceVertices> vertices;
    std::vector<Mat4> matrices;
    const Viewport viewport = Viewport::of(width, height);
    for (const DeviceDraw& d : draws) {
      Draw draw = d.draw;
      draw.source = {};
      draw.first_id = first_id + primitives_;
      primitives_ += draw.primitive_count;
      numbered.push_back(draw);
      matrices.push_back(static_cast<Mat4>(d.vertices.object_to_clip));
      DeviceVertices v = d.vertices;
      if (project_first && v.projected.empty() && !v.positions.empty()) {
        projected_.push_back(parallel::make_buffer<ProjectedVertex>(exec, v.positions.size()));
        parallel::transform(exec, v.positions, projected_.back(),
                            cuda_detail::ProjectVertex{matrices.back(), viewport});
        v.projected = {projected_.back().data(), projected_.back().size()};
      }
      vertices.push_back(v);
    }
    if (primitives_ > kMaxId || first_id > kMaxId - primitives_)
      throw Error(Errc::invalid_argument, "the scene has more primitives than there are ids");
    draws_ = parallel::upload(exec, numbered);
    vertices_ = parallel::upload(exec, vertices);
    matrices_ = parallel::upload(exec, matrices);
  }

  [[nodiscard]] std::uint64_t first_id() const { return first_id_; }
  [[nodiscard]] std::uint64_t primitives() const { return primitives_; }
  [[nodiscard]] DeviceGeometry geometry() const {
    return {width_,
            height_,
            Viewport::of(width_, height_),
            {draws_.data(), draws_.size()},
            {vertices_.data(), vertices_.size()},
            {matrices_.data(), matrices_.size()}};
  }

 private:
  std::uint64_t first_id_, primitives_ = 0;
  int width_, height_;
  Array<Draw> draws_;
  Array<DeviceVertices> vertices_;
  Array<Mat4> matrices_;
  std::vector<Array<ProjectedVertex>> projected_;
};

}  // namespace rastrum::raster
