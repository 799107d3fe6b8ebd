// SPDX-License-Identifier: BSD-3-Clause
// A host's draws as a device's. Arrays are copied if new or changed (kept_arrays.cuh). The host's
// threads run a vertex stage that is not a matrix over positions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/cuda/geometry.cuh>
#include <rastrum/raster/cuda/kept_arrays.cuh>
#include <rastrum/raster/draws/vertices.hpp>

namespace rastrum::raster {

/// A frame's copies of arrays on the device. The arrays must stay until the stream was waited for.
template <class Exec>
class Uploads {
 public:
  /// `in_place`: the arrays are on the device already and are not copied. `kept` must outlive this.
  Uploads(Exec& exec, KeptArrays<Exec>& kept, bool in_place)
      : exec_(&exec), kept_(&kept), in_place_(in_place) {
    kept.begin();
  }

  [[nodiscard]] bool in_place() const { return in_place_; }

  /// The copy, valid until the next frame. Does not wait.
  template <class T>
  [[nodiscard]] std::span<const T> operator()(std::span<const T> host) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (host.empty() || in_place_) return host;
    return {static_cast<const T*>((*kept_)(std::as_bytes(host))), host.size()};
  }
  /// A copy of an array that each frame makes anew; lives as long as this.
  template <class T>
  [[nodiscard]] std::span<const T> once(std::span<const T> host) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes& copy = made_.emplace_back(parallel::make_buffer<std::byte>(*exec_, host.size_bytes()));
    parallel::cuda_system::copy(exec_->stream(), copy.data(), host.data(), host.size_bytes());
    return {static_cast<const T*>(static_cast<const void*>(copy.data())), host.size()};
  }
  /// Copies of packed views.
  template <class T>
  [[nodiscard]] ArrayView<T> operator()(const ArrayView<T>& host) {
    return (*this)(host.packed());
  }
  [[nodiscard]] IndexView operator()(const IndexView& host) { return (*this)(host.packed()); }

 private:
  using Bytes = decltype(parallel::make_buffer<std::byte>(std::declval<Exec&>(), 0));
  Exec* exec_;
  KeptArrays<Exec>* kept_;
  bool in_place_;
  std::vector<Bytes> made_;
};

namespace cuda_detail {

/// Vertices projected by the host for a stage of its own.
struct HostVertices {
  std::vector<ProjectedVertex> projected;
  std::vector<Vec4d> clip;

  HostVertices(const Draw& draw, Viewport viewport, Isa isa, parallel::Threads& threads)
      : projected(draw.vertex_count), clip(draw.vertex_count) {
    constexpr std::size_t kGrain = 4096;
    parallel::for_each_index(threads, (draw.vertex_count + kGrain - 1) / kGrain,
                             [&](std::size_t part) {
                               const std::size_t begin = part * kGrain;
                               const std::size_t end = std::min(begin + kGrain, draw.vertex_count);
                               draw.source.project(begin, end, viewport, isa, &projected[begin]);
                               for (std::size_t i = begin; i < end; ++i)
                                 clip[i] = draw.source.clip_position(i);
                             });
  }
};

}  // namespace cuda_detail

/// The draws of a request on the device. `made` keeps the host's results until they are copied.
template <class Exec>
[[nodiscard]] std::vector<DeviceDraw> upload(Uploads<Exec>& uploads, const FrameRequest& request,
                                             parallel::Threads& threads,
                                             std::vector<cuda_detail::HostVertices>& made) {
  std::vector<DeviceDraw> draws;
  made.reserve(request.draws.size());
  const Viewport viewport = Viewport::of(request.width, request.height);
  for (const Draw& draw : request.draws) {
    DeviceDraw& d = draws.emplace_back();
    d.draw = draw;
    d.draw.indices = uploads(draw.indices);
    d.draw.face_materials = uploads(draw.face_materials);
    d.draw.material_flags = uploads(draw.material_flags);
    if (const MatrixVertices* const matrix = draw.source.matrix()) {
      d.vertices.positions = uploads(matrix->positions.packed());
      d.vertices.object_to_clip = matrix->object_to_clip;
    } else {
      if (uploads.in_place())
        throw Error(Errc::unsupported,
                    "arrays in the device's memory (in_place): a vertex stage of the host's "
                    "cannot read them");
      const auto& host = made.emplace_back(draw, viewport, request.isa, threads);
      d.vertices.projected = uploads.once(std::span(std::as_const(host.projected)));
      d.vertices.clip = uploads.once(std::span(std::as_const(host.clip)));
    }
  }
  return draws;
}

}  // namespace rastrum::raster
