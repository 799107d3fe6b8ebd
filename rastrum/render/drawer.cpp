#include <rastrum/render/drawer.hpp>

#include <algorithm>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/raster/frame/driver.hpp>
#include <rastrum/raster/frame/fast_path.hpp>
#include <rastrum/raster/frame/reference.hpp>
#include <rastrum/raster/frame/sampled_path.hpp>
#include <rastrum/render/device_work.hpp>
#include <rastrum/transparency/layered_path.hpp>
#include <rastrum/transparency/reference.hpp>

namespace rastrum {
namespace {

class ByNeed final : public raster::FrameDrawer {
 public:
  ByNeed(Methods methods, std::uint64_t memory_limit, MemoryAccount& memory,
         parallel::Threads* threads)
      : methods_(std::move(methods)),
        memory_limit_(memory_limit),
        memory_(memory),
        threads_(threads) {}

  [[nodiscard]] FrameStats draw(raster::FrameRequest& request) override {
    if (request.known != nullptr) return draw(request, keys_, methods_.keys, methods_.why_keys);
    const bool keys_alone =
        request.sink == nullptr || request.sink->takes == raster::FragmentSink::Takes::keys;
    const bool samples = methods_.samples && keys_alone && raster::is_sampled(request) &&
                         !blends(request.draws, request.transparency);
    if (samples) return draw(request, sampled_, methods_.samples, methods_.why_samples);
    if (needs_layers(request)) return draw(request, layers_, methods_.layers, methods_.why_layers);
    return draw(request, keys_, methods_.keys, methods_.why_keys);
  }

 private:
  FrameStats draw(raster::FrameRequest& request, std::unique_ptr<raster::FrameDriver>& driver,
                  const MakeMethod& make, const std::string& why) {
    // The reference's lists of layers cannot be cut.
    const bool limited = threads_ != nullptr || &driver == &keys_;
    if (!driver)
      driver = std::make_unique<raster::FrameDriver>(make(), limited ? memory_limit_ : 0, memory_,
                                                     threads_);
    FrameStats stats = driver->draw(request);
    if (!why.empty()) stats.why = why;
    return stats;
  }

  Methods methods_;
  std::uint64_t memory_limit_;
  MemoryAccount& memory_;
  parallel::Threads* threads_;
  std::unique_ptr<raster::FrameDriver> keys_, sampled_, layers_;
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
    if (request.cuts) return "clip planes are the CPU's";
    if (request.wants_surface || !request.targets.linear.empty())
      return "of the targets the device has color8, color, depth, ids and keys";
    if (request.part || request.known != nullptr) return "a part of a frame is the CPU's";
    if (request.sink != nullptr && needs_layers(request))
      return "layers that are handed on are the CPU's";
    if (std::ranges::any_of(request.draws,
                            [](const raster::Draw& d) { return d.quadrics != nullptr; }))
      return "spheres, cylinders, tubes and discs are the CPU's";
    if (!request.why_host.empty()) return request.why_host;
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
    text =
        "auto takes grouped: threads own bins, whose keys stay in cache and which skip what is "
        "hidden";
  if (layers)
    text.append(text.empty() ? "" : "; ")
        .append("layers, because something is translucent or pixels have several samples");
  else if (visibility)
    text.append(text.empty() ? "auto takes " : "; ")
        .append("atomic: a plain maximum where a thread owns the keys, and shading once a pixel");
  return text.empty() ? "as asked for" : text;
}

std::string why_samples(bool rasterizer) {
  constexpr const char* kSamples =
      "samples: a plain maximum at each, and shading once a pixel and primitive";
  return rasterizer ? why(true, false, false).append("; ").append(kSamples) : kSamples;
}

std::unique_ptr<raster::FrameDrawer> make_drawer_of(Methods methods, std::uint64_t memory_limit,
                                                    MemoryAccount& memory,
                                                    parallel::Threads* threads) {
  return std::make_unique<ByNeed>(std::move(methods), memory_limit, memory, threads);
}

std::unique_ptr<raster::FrameDrawer> make_reference_drawer(std::uint64_t memory_limit,
                                                           MemoryAccount& memory) {
  return make_drawer_of({raster::make_reference, transparency::make_layered_reference},
                        memory_limit, memory, nullptr);
}

std::unique_ptr<raster::FrameDrawer> make_device_drawer(DeviceFrames frames,
                                                        const DrawerOptions& options,
                                                        parallel::Threads& threads) {
  return std::make_unique<OnDevice>(std::move(frames), options.automatic_why, threads);
}

std::unique_ptr<raster::FrameDrawer> make_drawer(const DrawerOptions& options,
                                                 MemoryAccount& memory,
                                                 parallel::Threads* threads) {
  if (threads == nullptr) return make_reference_drawer(options.memory_limit, memory);
  const auto make_fast = [&memory, threads, limit = options.memory_limit] {
    return make_drawer_of(
        {[&memory] { return raster::make_fast_path(memory); },
         [&memory] { return transparency::make_layered_path(memory); }, why(true, true, false),
         why(true, true, true), [&memory] { return raster::make_sampled_path(memory); },
         why_samples(true)},
        limit, memory, threads);
  };
  if (options.device != Device::cuda) return make_fast();
  return make_device_drawer(
      {make_cuda_rasterizer(options.memory_limit, memory, *threads), {}, {}, make_fast}, options,
      *threads);
}

}  // namespace rastrum
