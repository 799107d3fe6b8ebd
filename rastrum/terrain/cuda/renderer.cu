// SPDX-License-Identifier: BSD-3-Clause
// TerrainRenderer's frames on a CUDA device. The map is copied once and kept; a frame copies its
// setup there and its picture back. One arena has the memory, so a frame of the same size allocates
// nothing.
#include <rastrum/terrain/cuda/device.hpp>
#include <rastrum/terrain/cuda/draw.cuh>
#include <rastrum/terrain/cuda/functions.cuh>

#include <memory>
#include <optional>

namespace rastrum::terrain {
namespace {

template <class T>
struct RollPixel {
  Roll roll;
  ImageView<const T> upright;
  RASTRUM_HD T operator()(int x, int y) const { return roll(upright, x, y); }
};

template <class T>
class DevicePicture {
 public:
  /// Empty if `wanted` is.
  [[nodiscard]] ImageView<T> sized(parallel::Cuda& exec, const ImageView<T>& wanted, int width,
                                   int height) {
    if (wanted.empty()) return {};
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (pixels_.size() != pixels) {
      pixels_ = {};
      pixels_ = parallel::make_buffer<T>(exec, pixels);
    }
    return {pixels_.data(), width, height, width};
  }
  /// Rotates `upright` into an image as large as `wanted`, unless that is empty.
  void roll(parallel::Cuda& exec, const Roll& roll, const ImageView<T>& upright,
            const ImageView<T>& wanted) {
    if (wanted.empty()) return;
    static_cast<void>(sized(exec, wanted, wanted.width, wanted.height));
    const ImageView<const T> from{upright.data, upright.width, upright.height, upright.stride};
    parallel::tabulate(exec, pixels_,
                       cuda_detail::CellOfIndex<RollPixel<T>>{{roll, from}, wanted.width});
  }
  /// Starts a copy; does not wait.
  void copy_to(parallel::Cuda& exec, const ImageView<T>& target) {
    if (target.empty()) return;
    parallel::copy_image(exec, pixels_.data(), static_cast<std::size_t>(target.width), target.data,
                         target.stride, static_cast<std::size_t>(target.height), false);
  }

 private:
  parallel::DeviceBuffer<T> pixels_;
};

class CudaRenderer final : public DeviceRenderer {
 public:
  explicit CudaRenderer(const MethodOnDevice* words) : words_(words) {}
  [[nodiscard]] std::uint64_t bytes() const override { return memory_.held(); }

 private:
  Counts draw(const Terrain& terrain, const TerrainOptions& options, const TerrainCamera& camera,
              const Roll* roll, const TerrainTargets& targets,
              const std::function<void(const char* stage)>& lap, const StopToken* stop) override {
    return parallel::on_device_of(
        exec_, [&] { return draw_picture(terrain, options, camera, roll, targets, lap, stop); });
  }
  Counts draw_picture(const Terrain& terrain, const TerrainOptions& options,
                      const TerrainCamera& camera, const Roll* roll, const TerrainTargets& targets,
                      const std::function<void(const char* stage)>& lap, const StopToken* stop) {
    const StopScope scope(stop);
    if (terrain.is_map()) keep(terrain, options.filter == MapFilter::mip);
    lap("map");
    const int width = options.width, height = options.height;
    const TerrainTargets on_device{colors_.sized(exec_, targets.color8, width, height),
                                   depths_.sized(exec_, targets.depth, width, height)};
    const Counts counts =
        terrain.is_map()
            ? draw_frame(exec_, *map_, options, camera, on_device, words_)
            : draw_frame(exec_, *function_view(terrain), options, camera, on_device, words_);
    if (roll != nullptr) {
      rolled_colors_.roll(exec_, *roll, on_device.color8, targets.color8);
      rolled_depths_.roll(exec_, *roll, on_device.depth, targets.depth);
    }
    lap("draw");
    (roll != nullptr ? rolled_colors_ : colors_).copy_to(exec_, targets.color8);
    (roll != nullptr ? rolled_depths_ : depths_).copy_to(exec_, targets.depth);
    exec_.wait();
    lap("copy");
    return counts;
  }
  void keep(const Terrain& terrain, bool whole) {
    const bool heights = kept_heights_ != terrain.heights();
    const bool colors = kept_colors_ != terrain.colors();
    if (map_ && !heights && !colors && whole == whole_) return;
    map_.reset();
    // Old arrays are freed before new ones are copied, and count as kept only after the copy.
    if (heights) {
      kept_heights_ = {};
      cells_ = {};
      cells_ = parallel::to_device(exec_, terrain.heights()->pixels());
      kept_heights_ = terrain.heights();
    }
    if (colors) {
      kept_colors_ = {};
      texels_ = {};
      texels_ = parallel::to_device(exec_, terrain.colors()->pixels());
      kept_colors_ = terrain.colors();
    }
    const int width = kept_heights_->width(), color_width = kept_colors_->width();
    map_.emplace(exec_,
                 DeviceCells{{cells_.data(), width, kept_heights_->height(), width},
                             {texels_.data(), color_width, kept_colors_->height(), color_width}},
                 whole);
    whole_ = whole;
  }

  const MethodOnDevice* words_;
  MemoryAccount memory_;
  parallel::Cuda exec_{&memory_};
  Shared<const Image<float>> kept_heights_;
  Shared<const Image<Rgba8>> kept_colors_;
  parallel::DeviceBuffer<float> cells_;
  parallel::DeviceBuffer<Rgba8> texels_;
  std::optional<DeviceMap> map_;
  bool whole_ = false;
  DevicePicture<Rgba8> colors_, rolled_colors_;
  DevicePicture<float> depths_, rolled_depths_;
};

}  // namespace

std::unique_ptr<DeviceRenderer> make_cuda_renderer(const MethodOnDevice* words) {
  return std::make_unique<CudaRenderer>(words);
}

}  // namespace rastrum::terrain
