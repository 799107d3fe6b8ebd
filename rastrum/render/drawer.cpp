// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/drawer.hpp>

#include <array>
#include <utility>

#include <rastrum/core/number_text.hpp>
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

using raster::FramePlan;
using raster::FrameRequest;
using Path = FramePlan::Path;

/// FramePlan::why of the CPU's ways.
std::string why(const Ways::Automatic& chosen, Path path) {
  std::string text, found;
  if (chosen.rasterizer)
    text =
        "auto takes grouped: threads own bins, whose keys stay in cache and which skip what is "
        "hidden";
  if (path == Path::layers)
    found = "layers, because something is translucent or pixels have several samples";
  else if (path == Path::samples)
    found = "samples: a plain maximum at each, and shading once a pixel and primitive";
  else if (chosen.visibility)
    found = std::string(text.empty() ? "auto takes " : "") +
            "atomic: a plain maximum where a thread owns the keys, and shading once a pixel";
  text.append(text.empty() || found.empty() ? "" : "; ").append(found);
  return text.empty() ? "as asked for" : text;
}

class Drawer final : public raster::FrameDrawer {
 public:
  Drawer(std::function<Ways()> make_ways, const DrawerOptions& options, MemoryAccount& memory,
         parallel::Threads* threads, DeviceFrames device)
      : make_ways_(std::move(make_ways)),
        device_(std::move(device)),
        there_{Device::cuda, options.automatic_why},
        memory_limit_(options.memory_limit),
        memory_(memory),
        threads_(threads) {
    if (!device_.device) (void)ways();
  }

  [[nodiscard]] FrameStats draw(FrameRequest& request) override {
    const FramePlan plan = this->plan(request);
    const bool on_device = plan.path == Path::device;
    FrameStats stats =
        on_device ? device_.device->render(request) : driver(plan.path).draw(request, plan);
    if (on_device && !plan.why.empty()) stats.why = text_of(plan.why, "; ", stats.why);
    if (stats.device_why.empty()) stats.device_why = plan.device_why;
    return stats;
  }
  [[nodiscard]] FrameStats shade(FrameRequest& request, const raster::KnownBlocks& known) override {
    return driver(Path::keys).shade(request, known);
  }

 private:
  /// Nothing else decides the way of a frame.
  [[nodiscard]] FramePlan plan(const FrameRequest& request) {
    const bool has_layers = request.needs_layers();
    DeviceChoice choice = choose(request, has_layers);
    if (choice.device == Device::cuda)
      return {.path = Path::device, .why = device_.why, .device_why = std::move(choice.why)};
    if (request.device.in_place)
      throw Error(Errc::unsupported,
                  std::string("arrays in the device's memory (in_place): ").append(choice.why));
    Path path = Path::keys;
    if (has_layers) path = ways().samples && is_sampled(request) ? Path::samples : Path::layers;
    FramePlan plan = driver(path).plan(request);
    plan.path = path;
    if (ways().automatic) plan.why = why(*ways().automatic, path);
    plan.device_why = std::move(choice.why);
    return plan;
  }
  /// Whether triangles, points and lines with several samples are opaque and drawn over no picture.
  [[nodiscard]] static bool is_sampled(const FrameRequest& request) {
    return request.samples > 1 && !request.pass.over && !request.has_quadrics() &&
           (request.sink == nullptr || request.sink->fate == raster::Translucent::keys_to_sink) &&
           !raster::blends(request.draws, request.transparency);
  }
  [[nodiscard]] DeviceChoice choose(const FrameRequest& request, bool has_layers) const {
    if (!device_.device) return {Device::threads, device_.why_host};
    if (std::string why_not = why_not_there(request, has_layers); !why_not.empty())
      return {Device::threads, std::move(why_not)};
    if (there_.why.empty() || request.device.in_place) return there_;
    return choose_device(there_, device_work(request), threads_->concurrency());
  }
  /// Why the device leaves a frame to the CPU; empty where it draws it.
  [[nodiscard]] std::string why_not_there(const FrameRequest& request, bool has_layers) const {
    if (request.has_cuts()) return "only the CPU has clip planes";
    if (raster::wants_surface(request.targets) || !request.targets.linear.empty())
      return "the device has only the targets color8, color, depth, ids and keys";
    if (request.part) return "only the CPU draws a part of a frame";
    if (request.sink != nullptr && has_layers) return "only the CPU hands layers on";
    if (request.has_quadrics()) return "only the CPU draws spheres, cylinders, tubes and discs";
    if (!request.device.why_not.empty()) return request.device.why_not;
    return device_.device->why_not(request);
  }

  const Ways& ways() {
    if (!ways_) ways_ = make_ways_();
    return *ways_;
  }
  raster::FrameDriver& driver(Path path) {
    const Ways& w = ways();
    const auto& make = path == Path::keys ? w.keys : path == Path::samples ? w.samples : w.layers;
    std::unique_ptr<raster::FrameDriver>& driver = drivers_[static_cast<std::size_t>(path)];
    // The reference's lists of layers cannot be split.
    const bool limited = threads_ != nullptr || path == Path::keys;
    if (!driver)
      driver = std::make_unique<raster::FrameDriver>(make(), limited ? memory_limit_ : 0, memory_,
                                                     threads_);
    return *driver;
  }

  std::function<Ways()> make_ways_;
  std::optional<Ways> ways_;
  DeviceFrames device_;
  DeviceChoice there_;
  std::uint64_t memory_limit_;
  MemoryAccount& memory_;
  parallel::Threads* threads_;
  std::array<std::unique_ptr<raster::FrameDriver>, 3> drivers_;  ///< by path
};

}  // namespace

std::unique_ptr<raster::FrameDrawer> make_drawer_of(std::function<Ways()> make_ways,
                                                    const DrawerOptions& options,
                                                    MemoryAccount& memory,
                                                    parallel::Threads* threads,
                                                    DeviceFrames device) {
  return std::make_unique<Drawer>(std::move(make_ways), options, memory, threads,
                                  std::move(device));
}

std::unique_ptr<raster::FrameDrawer> make_reference_drawer(std::uint64_t memory_limit,
                                                           MemoryAccount& memory) {
  return make_drawer_of(
      [] {
        return Ways{{raster::make_reference}, {transparency::make_layered_reference}};
      },
      {.memory_limit = memory_limit}, memory, nullptr);
}

std::unique_ptr<raster::FrameDrawer> make_drawer(const DrawerOptions& options,
                                                 MemoryAccount& memory,
                                                 parallel::Threads* threads) {
  if (threads == nullptr) return make_reference_drawer(options.memory_limit, memory);
  DeviceFrames device;
  if (options.device == Device::cuda)
    device.device = make_cuda_rasterizer(options.memory_limit, memory, *threads);
  const auto make_ways = [&memory] {
    return Ways{[&memory] { return raster::make_fast_path(memory); },
                [&memory] { return transparency::make_layered_path(memory); },
                [&memory] { return raster::make_sampled_path(memory); },
                {{true, true}}};
  };
  return make_drawer_of(make_ways, options, memory, threads, std::move(device));
}

}  // namespace rastrum
