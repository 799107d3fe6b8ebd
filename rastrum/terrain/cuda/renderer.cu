// TerrainRenderer's frames on a CUDA device: the map is copied there once and kept, a frame copies
// its setup there and its picture back. Memory comes from one arena, so a frame like the one before
// allocates nothing.
#include <rastrum/terrain/cuda/device.hpp>
#include <rastrum/terrain/cuda/draw.cuh>

#include <memory>
#include <optional>

namespace rastrum::terrain {
namespace {

/// A picture of one kind on the device, and its way back.
template <class T>
class DevicePicture {
 public:
  /// As large as `wanted`, or nothing where that is empty.
  [[nodiscard]] ImageView<T> like(parallel::Cuda& exec, const ImageView<T>& wanted) {
    if (wanted.empty()) return {};
    const std::size_t pixels =
        static_cast<std::size_t>(wanted.width) * static_cast<std::size_t>(wanted.height);
    if (pixels_.size() != pixels) {
      pixels_ = {};
      pixels_ = parallel::make_buffer<T>(exec, pixels);
    }
    return {pixels_.data(), wanted.width, wanted.height, wanted.width};
  }
  /// Does not wait.
  void copy_to(parallel::Cuda& exec, const ImageView<T>& target) const {
    if (target.empty()) return;
    const auto width = static_cast<std::size_t>(target.width);
    const bool whole = target.stride == target.width;
    const int parts = whole ? 1 : target.height;
    const std::size_t pixels = whole ? pixels_.size() : width;
    for (int y = 0; y < parts; ++y)
      parallel::cuda_system::copy(exec.stream(), target.row(y),
                                  pixels_.data() + static_cast<std::size_t>(y) * width,
                                  pixels * sizeof(T));
  }

 private:
  parallel::DeviceBuffer<T> pixels_;
};

class CudaRenderer final : public DeviceRenderer {
 public:
  Counts draw(const Terrain& map, const TerrainOptions& options, const TerrainCamera& camera,
              const TerrainTargets& targets,
              const std::function<void(const char* stage)>& lap) override {
    keep(map, options.filter == Filter::mip);
    lap("map");
    const TerrainTargets on_device{colors_.like(exec_, targets.color8),
                                   depths_.like(exec_, targets.depth)};
    const Counts counts = draw_frame(exec_, *map_, options, camera, on_device);
    lap("draw");
    colors_.copy_to(exec_, targets.color8);
    depths_.copy_to(exec_, targets.depth);
    exec_.wait();
    lap("copy");
    return counts;
  }
  [[nodiscard]] std::uint64_t bytes() const override { return memory_.held(); }

 private:
  void keep(const Terrain& terrain, bool whole) {
    const bool heights = kept_heights_ != terrain.heights();
    const bool colors = kept_colors_ != terrain.colors();
    if (map_ && !heights && !colors && whole == whole_) return;
    map_.reset();
    // What is to be replaced goes first; what fails to come is not taken for kept.
    if (heights) {
      kept_heights_.reset();
      cells_ = {};
      cells_ = parallel::to_device(exec_, terrain.heights()->pixels());
      kept_heights_ = terrain.heights();
    }
    if (colors) {
      kept_colors_.reset();
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

  MemoryAccount memory_;
  parallel::Cuda exec_{&memory_};
  std::shared_ptr<const Image<float>> kept_heights_;
  std::shared_ptr<const Image<Rgba8>> kept_colors_;
  parallel::DeviceBuffer<float> cells_;
  parallel::DeviceBuffer<Rgba8> texels_;
  std::optional<DeviceMap> map_;
  bool whole_ = false;
  DevicePicture<Rgba8> colors_;
  DevicePicture<float> depths_;
};

}  // namespace

std::unique_ptr<DeviceRenderer> make_device_renderer() {
  return std::make_unique<CudaRenderer>();
}

}  // namespace rastrum::terrain
