// The targets of a band of rows on a device: copies of what the caller has on the host, or in place
// the caller's own.
#pragma once

#include <cstddef>
#include <cstdint>

#include <rastrum/image.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/frame/request.hpp>

namespace rastrum::raster {

/// A band of one image; nothing where the caller has none.
template <class T>
class BandImage {
 public:
  /// `keeps`: with what the image holds.
  BandImage(parallel::Cuda& exec, const ImageView<T>& host, Rect view, bool in_place, bool keeps)
      : exec_(exec),
        host_(host),
        view_(view),
        in_place_(in_place),
        pixels_(parallel::make_buffer<T>(exec, host.empty() || in_place ? 0 : area_of(view))) {
    if (keeps && pixels_.size() > 0) copy(true);
  }
  [[nodiscard]] ImageView<T> on_device() {
    const int width = view_.x1 - view_.x0;
    if (in_place_ && !host_.empty())
      return {host_.row(view_.y0), width, view_.y1 - view_.y0, host_.stride};
    return {pixels_.data(), width, view_.y1 - view_.y0, width};
  }
  /// Does not wait.
  void store() {
    if (pixels_.size() > 0) copy(false);
  }

 private:
  void copy(bool to_device) {
    const auto rows = static_cast<std::size_t>(view_.y1 - view_.y0);
    parallel::copy_image(exec_, pixels_.data(), static_cast<std::size_t>(view_.x1 - view_.x0),
                         host_.row(view_.y0), host_.stride, rows, to_device);
  }

  parallel::Cuda& exec_;
  ImageView<T> host_;
  Rect view_;
  bool in_place_;
  parallel::DeviceBuffer<T> pixels_;
};

/// A band of all targets; with what they hold, where they keep it.
class BandImages {
 public:
  /// `resolves`: they are wanted; else but what tests read.
  BandImages(parallel::Cuda& exec, const FrameRequest& request, Rect view, bool resolves)
      : exec_(exec),
        color8_(of(exec, request, request.targets.color8, view, resolves)),
        color_(of(exec, request, request.targets.color, view, resolves)),
        depth_(of(exec, request, request.targets.depth, view, resolves || request.targets.over)),
        ids_(of(exec, request, request.targets.ids, view, resolves)),
        keys_(of(exec, request, request.targets.keys, view, resolves)) {}

  [[nodiscard]] ImageView<const float> depth_behind(const FrameRequest& request) {
    if (!request.targets.over) return {};
    const ImageView<float> d = depth_.on_device();
    return {d.data, d.width, d.height, d.stride};
  }

  /// Fills all, and the caller's once the device was waited for; adds how many pixels hold a
  /// surface to *covered, of the device. Where *held is not 0 it leaves them (resolve_surface), and
  /// is to be called again.
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

 private:
  template <class T>
  static BandImage<T> of(parallel::Cuda& exec, const FrameRequest& request,
                         const ImageView<T>& target, Rect view, bool wanted) {
    return BandImage<T>(exec, wanted ? target : ImageView<T>{}, view, request.in_place,
                        request.targets.over || request.targets.load);
  }

  parallel::Cuda& exec_;
  BandImage<Rgba8> color8_;
  BandImage<Vec4> color_;
  BandImage<float> depth_;
  BandImage<std::int64_t> ids_;
  BandImage<std::uint64_t> keys_;
};

}  // namespace rastrum::raster
