#include <rastrum/render/drawer.hpp>

#include <algorithm>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/raster/frame/rasterizer.hpp>
#include <rastrum/raster/frame/reference.hpp>
#include <rastrum/render/device_work.hpp>
#include <rastrum/transparency/layers.hpp>
#include <rastrum/transparency/reference.hpp>

namespace rastrum {
namespace {

class Reference final : public raster::FrameDrawer {
 public:
  explicit Reference(MemoryAccount& memory) : memory_(memory) {}
  [[nodiscard]] FrameStats draw(raster::FrameRequest& request) override {
    return needs_layers(request) ? transparency::render_reference(request, memory_)
                                 : raster::render_reference(request, memory_);
  }

 private:
  MemoryAccount& memory_;
};

/// The one fast path, with exact layers where keys are not enough.
class Fast final : public raster::FrameDrawer {
 public:
  Fast(std::uint64_t memory_limit, MemoryAccount& memory, parallel::Threads& threads)
      : memory_limit_(memory_limit),
        memory_(memory),
        threads_(threads),
        opaque_(make(raster::visibilities().front())) {}

  [[nodiscard]] FrameStats draw(raster::FrameRequest& request) override {
    const bool layers = needs_layers(request);
    if (layers && !layered_) layered_ = make(transparency::layers());
    FrameStats stats = (layers ? layered_ : opaque_)->render(request);
    stats.why = why(true, true, layers);
    return stats;
  }

 private:
  [[nodiscard]] std::unique_ptr<raster::Rasterizer> make(const raster::Visibility& visibility) {
    return std::make_unique<raster::Rasterizer>(raster::coverages().front(), visibility,
                                                raster::Tuning{}, memory_limit_, memory_, threads_);
  }

  std::uint64_t memory_limit_;
  MemoryAccount& memory_;
  parallel::Threads& threads_;
  std::unique_ptr<raster::Rasterizer> opaque_, layered_;
};

class OnDevice final : public raster::FrameDrawer {
 public:
  OnDevice(DeviceFrames frames, std::string automatic_why, parallel::Threads& threads)
      : frames_(std::move(frames)),
        there_{Device::cuda, std::move(automatic_why)},
        threads_(threads) {}

  [[nodiscard]] FrameStats draw(raster::FrameRequest& request) override {
    DeviceChoice choice = choose(request);
    if (choice.device == Device::cuda) {
      FrameStats stats = frames_.device->render(request);
      if (!frames_.why.empty()) stats.why = std::string(frames_.why).append("; ").append(stats.why);
      if (stats.device_why.empty()) stats.device_why = std::move(choice.why);
      return stats;
    }
    if (request.in_place)
      throw Error(Errc::unsupported,
                  std::string("arrays in the device's memory (in_place): ").append(choice.why));
    if (!host_) host_ = frames_.make_host();
    FrameStats stats = host_->draw(request);
    stats.device = Device::threads;
    stats.device_why = std::move(choice.why);
    return stats;
  }

 private:
  [[nodiscard]] DeviceChoice choose(const raster::FrameRequest& request) const {
    if (std::string why_not = frames_.device ? why_not_there(request) : frames_.why_host;
        !why_not.empty())
      return {Device::threads, std::move(why_not)};
    if (there_.why.empty() || request.in_place) return there_;
    return choose_device(there_, device_work(request), threads_.concurrency());
  }
  /// Why the device leaves a frame to the CPU; empty where it draws it.
  [[nodiscard]] std::string why_not_there(const raster::FrameRequest& request) const {
    if (std::string why_not = frames_.device->why_no_test(request); !why_not.empty())
      return why_not;
    return needs_layers(request) ? frames_.device->why_no_layers(request) : std::string();
  }

  DeviceFrames frames_;
  DeviceChoice there_;
  parallel::Threads& threads_;
  std::unique_ptr<raster::FrameDrawer> host_;
};

}  // namespace

bool blends(std::span<const raster::Draw> draws, const TransparencyOptions& options) {
  return options.method != Transparency::none &&
         std::ranges::any_of(draws, [](const raster::Draw& d) {
           return (d.any_flags() & raster::kTranslucent) != 0;
         });
}

bool needs_layers(const raster::FrameRequest& request) {
  return request.samples > 1 || blends(request.draws, request.transparency);
}

std::string why(bool rasterizer, bool visibility, bool layers) {
  std::string text;
  if (rasterizer)
    text.append("auto takes ")
        .append(raster::coverages().front().name)
        .append(": threads own bins, whose keys stay in cache and which skip what is hidden");
  if (layers)
    text.append(text.empty() ? "" : "; ")
        .append("layers, because something is translucent or pixels have several samples");
  else if (visibility)
    text.append(text.empty() ? "auto takes " : "; ")
        .append(raster::visibilities().front().name)
        .append(": a plain maximum where a thread owns the keys, and shading once a pixel");
  return text.empty() ? "as asked for" : text;
}

std::unique_ptr<raster::FrameDrawer> make_device_drawer(DeviceFrames frames,
                                                        const DrawerOptions& options,
                                                        parallel::Threads& threads) {
  return std::make_unique<OnDevice>(std::move(frames), options.automatic_why, threads);
}

std::unique_ptr<raster::FrameDrawer> make_drawer(const DrawerOptions& options,
                                                 MemoryAccount& memory,
                                                 parallel::Threads* threads) {
  if (threads == nullptr) return std::make_unique<Reference>(memory);
  const auto make_fast = [&memory, threads, limit = options.memory_limit] {
    return std::make_unique<Fast>(limit, memory, *threads);
  };
  if (options.device != Device::cuda) return make_fast();
  return make_device_drawer(
      {raster::make_cuda_rasterizer({}, {}, options.memory_limit, memory, *threads),
       {},
       {},
       make_fast},
      options, *threads);
}

}  // namespace rastrum
