// SPDX-License-Identifier: BSD-3-Clause
// The targets of a band of rows on a device: copies of the caller's host arrays or, in place, the
// caller's own. Results return through pinned memory, so that the host need not wait for each; its
// threads copy them to the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <rastrum/image.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/cuda/resolve.cuh>

namespace rastrum::raster {

/// Empty if the caller has no such image.
template <class T>
class BandImage {
 public:
  /// `keeps`: starts with the image's contents.
  BandImage(parallel::Cuda& exec, const ImageView<T>& host, Rect view, bool in_place, bool keeps)
      : exec_(exec),
        host_(host),
        view_(view),
        in_place_(in_place),
        pixels_(parallel::make_buffer<T>(exec, host.empty() || in_place ? 0 : area_of(view))) {
    if (keeps && pixels_.size() > 0) load();
  }
  [[nodiscard]] ImageView<T> on_device() {
    const int width = view_.x1 - view_.x0;
    if (in_place_ && !host_.empty())
      return {host_.row(view_.y0), width, view_.y1 - view_.y0, host_.stride};
    return {pixels_.data(), width, view_.y1 - view_.y0, width};
  }
  /// Starts the copy to the host and does not wait.
  void store() {
    const std::size_t bytes = pixels_.size() * sizeof(T);
    if (bytes == 0) return;
    staged_ = parallel::pinned_buffer(exec_, bytes);
    parallel::cuda_system::copy(exec_.stream(), staged_.data(), pixels_.data(), bytes);
  }
  /// Copies to the caller, once the device has been waited for.
  void deliver(parallel::Threads& threads) {
    if (staged_.empty()) return;
    constexpr std::size_t kRowGrain = 16;
    const std::size_t row_bytes = static_cast<std::size_t>(view_.x1 - view_.x0) * sizeof(T);
    parallel::for_each_index(
        threads, static_cast<std::size_t>(view_.y1 - view_.y0),
        [&](std::size_t y) {
          std::memcpy(static_cast<void*>(host_.row(view_.y0 + static_cast<int>(y))),
                      staged_.data() + y * row_bytes, row_bytes);
        },
        kRowGrain);
  }

 private:
  void load() {
    const auto rows = static_cast<std::size_t>(view_.y1 - view_.y0);
    parallel::copy_image(exec_, pixels_.data(), static_cast<std::size_t>(view_.x1 - view_.x0),
                         host_.row(view_.y0), host_.stride, rows, true);
  }

  parallel::Cuda& exec_;
  ImageView<T> host_;
  Rect view_;
  bool in_place_;
  parallel::DeviceBuffer<T> pixels_;
  parallel::Buffer<std::byte> staged_;
};

/// A band of all targets, with their contents if the frame draws over or loads them.
class BandImages {
 public:
  /// `resolves`: all targets are wanted, else only those that tests read.
  BandImages(parallel::Cuda& exec, const FrameRequest& request, Rect view, bool resolves)
      : exec_(exec),
        color8_(of(exec, request, request.targets.color8, view, resolves)),
        color_(of(exec, request, request.targets.color, view, resolves)),
        depth_(of(exec, request, request.targets.depth, view, resolves || request.pass.over)),
        ids_(of(exec, request, request.targets.ids, view, resolves)),
        keys_(of(exec, request, request.targets.keys, view, resolves)) {}

  [[nodiscard]] ImageView<const float> depth_behind(const FrameRequest& request) {
    if (!request.pass.over) return {};
    const ImageView<float> d = depth_.on_device();
    return {d.data, d.width, d.height, d.stride};
  }

  /// Fills all targets; adds the number of covered pixels to *covered, in device memory. If *held
  /// is not 0 it leaves the targets (resolve_surface) and must be called again.
  template <class Shade>
  void resolve(const FrameRequest& request, const Shade& shade, const DeviceSurface& surface,
               std::uint64_t* covered, const std::uint64_t* held) {
    const DeviceTargets targets{color8_.on_device(), color_.on_device(), depth_.on_device(),
                                ids_.on_device(), keys_.on_device()};
    resolve_surface(exec_, surface, targets, shade, ResolveRules::of(request), covered, held);
    color8_.store();
    color_.store();
    depth_.store();
    ids_.store();
    keys_.store();
  }
  /// As BandImage::deliver.
  void deliver(parallel::Threads& threads) {
    color8_.deliver(threads);
    color_.deliver(threads);
    depth_.deliver(threads);
    ids_.deliver(threads);
    keys_.deliver(threads);
  }

 private:
  template <class T>
  static BandImage<T> of(parallel::Cuda& exec, const FrameRequest& request,
                         const ImageView<T>& target, Rect view, bool wanted) {
    return BandImage<T>(exec, wanted ? target : ImageView<T>{}, view, request.device.in_place,
                        request.pass.over || request.pass.load);
  }

  parallel::Cuda& exec_;
  BandImage<Rgba8> color8_;
  BandImage<Vec4> color_;
  BandImage<float> depth_;
  BandImage<std::int64_t> ids_;
  BandImage<std::uint64_t> keys_;
};

}  // namespace rastrum::raster
