// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/terrain.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <rastrum/core/no_memory.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/terrain/added_method.hpp>
#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/cuda/device.hpp>
#include <rastrum/terrain/device_work.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/roll.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace {

class Stopwatch {
 public:
  explicit Stopwatch(TerrainStats& stats) : stats_(stats) {}
  void lap(const char* stage) {
    const double now = std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    stats_.stages.push_back({stage, stats_.frame_ms, now});
    stats_.frame_ms = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  TerrainStats& stats_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

struct TerrainRenderer::Impl {
  static const TerrainRendererOptions& checked(const TerrainRendererOptions& options) {
    if (options.threads < 0) reject("terrain: the number of threads must be at least 0 (all)");
    return options;
  }
  explicit Impl(TerrainRendererOptions given)
      : options(checked(given)),
        isa(choose_isa(options.isa)),
        asked(options.device),
        pool(memory),
        serial(&memory) {
    DeviceChoice choice = choose_device(options.device);
    options.device = choice.device;
    device_why = std::move(choice.why);
    if (options.device == Device::threads) static_cast<void>(threads());
    if (options.device == Device::cuda) gpu = make_device_renderer();
  }

  [[nodiscard]] parallel::Threads& threads() {
    if (!exec) exec.emplace(options.threads, &memory);
    return *exec;
  }
  /// One made by an added method draws all frames.
  DeviceRenderer& gpu_for(const TerrainOptions& how) {
    if (const AddedMethod* method = added_for(how); method != nullptr && method != on_gpu) {
      gpu = method->make_device_renderer();
      on_gpu = method;
    }
    return *gpu;
  }
  [[nodiscard]] static const AddedMethod* added_for(const TerrainOptions& how) {
    return how.classic ? nullptr : how.added;
  }
  [[nodiscard]] DeviceChoice place(const Terrain& terrain, const TerrainOptions& how,
                                   const TerrainTargets& targets) {
    DeviceChoice choice{options.device, device_why};
    if (options.device != Device::cuda) return choice;
    std::string why_not = why_not_on_device(terrain, how);
    const bool is_drawn_there = why_not.empty();
    const AddedMethod* method = added_for(how);
    std::uint64_t bytes = is_drawn_there ? device_bytes(terrain, how) : 0;
    if (is_drawn_there && method != nullptr)
      bytes +=
          method->device_bytes(static_cast<std::uint64_t>(std::min(slice_count(how), kMaxSlices)));
    if (bytes > fits_gpu) {
      const std::uint64_t free = parallel::cuda_status().free_bytes + gpu->bytes();
      if (bytes > free)
        why_not = text_of(terrain.is_map() ? text_of("a map of ", terrain.heights()->width(), "x",
                                                     terrain.heights()->height(), " cells")
                                           : "a function",
                          " in a picture of ", how.width, "x", how.height, " takes up to ",
                          (bytes >> 20) + 1, " MiB of the GPU's memory, and ", free >> 20,
                          " MiB are free");
      else
        fits_gpu = bytes;
    }
    if (why_not.empty()) {
      if (asked != Device::automatic) return choice;
      FrameWork work = device_work(terrain, how, targets);
      if (method != nullptr) method->weigh(work);
      return choose_device(choice, work, threads().concurrency());
    }
    if (is_drawn_there && asked == Device::cuda)
      throw Error(Errc::out_of_memory, text_of("terrain: ", why_not, "; use --device threads"));
    return {Device::threads, std::string("no CUDA: ").append(why_not)};
  }

  /// Computes what is needed once per map.
  void prepare(const Terrain& terrain, const TerrainOptions& how, Device where) {
    if (!terrain.is_map() || where == Device::cuda) return;
    if (where == Device::threads && !(ceiling && ceiling->is_of(terrain)))
      ceiling.emplace(terrain.heights());
    const bool whole = how.filter == MapFilter::mip;
    if (!(pyramid && pyramid->is_of(terrain, whole)))
      pyramid.emplace(terrain.heights(), terrain.colors(), whole);
  }

  /// `roll`: null for an upright picture. Only a device uses it.
  Counts draw(const Terrain& terrain, const TerrainOptions& how, const TerrainCamera& camera,
              const Roll* roll, const TerrainTargets& targets, TerrainStats& stats,
              Stopwatch& stopwatch) {
    if (stats.device == Device::cuda) {
      const auto lap = [&](const char* stage) { stopwatch.lap(stage); };
      const Counts counts = gpu_for(how).draw(terrain, how, camera, roll, targets, lap);
      stats.slices = counts.slices;
      stats.device_bytes = gpu->bytes();
      return counts;
    }
    const bool on_threads = stats.device == Device::threads;
    if (how.classic) {
      if (on_threads && terrain.is_map())
        return draw_classic(threads(), isa, pool, terrain, *ceiling, how, camera, targets);
      return draw_classic_reference(terrain, how, camera, targets);
    }
    const Setup setup = set_up(how, camera, terrain);
    stats.slices = setup.slices.size();
    Samples samples{{setup, {}}, terrain, ceiling ? &*ceiling : nullptr};
    if (terrain.is_map()) samples.map = MapView(*pyramid, how, setup);
    if (const AddedMethod* method = added_for(how))
      return on_threads ? method->on_threads(threads(), samples, targets)
                        : method->on_serial(serial, samples, targets);
    return on_threads ? draw_fast(threads(), isa, pool, samples, targets)
                      : draw_reference(samples, targets);
  }

  Counts draw_rolled(const Terrain& terrain, const TerrainOptions& how, const TerrainCamera& camera,
                     const TerrainTargets& targets, TerrainStats& stats, Stopwatch& stopwatch) {
    const Upright upright = upright_of(how, camera);
    const Roll roll(camera.roll_rad, how.width, how.height);
    if (stats.device == Device::cuda)
      return draw(terrain, upright.options, upright.camera, &roll, targets, stats, stopwatch);
    Image<Rgba8> colors;
    Image<float> depth;
    TerrainTargets whole;
    if (!targets.color8.empty()) {
      colors = Image<Rgba8>(upright.options.width, upright.options.height);
      whole.color8 = colors.view();
    }
    if (!targets.depth.empty()) {
      depth = Image<float>(upright.options.width, upright.options.height);
      whole.depth = depth.view();
    }
    const Counts counts =
        draw(terrain, upright.options, upright.camera, nullptr, whole, stats, stopwatch);
    const auto row = [&](std::size_t number) {
      const int y = static_cast<int>(number);
      for (int x = 0; x < how.width; ++x) {
        if (!colors.empty()) targets.color8(x, y) = roll(std::as_const(colors).view(), x, y);
        if (!depth.empty()) targets.depth(x, y) = roll(std::as_const(depth).view(), x, y);
      }
    };
    parallel::for_each_index(stats.device == Device::serial ? nullptr : &threads(),
                             static_cast<std::size_t>(how.height), row);
    stats.peak_bytes += colors.pixels().size_bytes() + depth.pixels().size_bytes();
    return counts;
  }

  std::mutex one_at_a_time;
  TerrainRendererOptions options;
  Isa isa;
  Device asked;
  std::string device_why;
  MemoryAccount memory;
  BlockPool pool;
  parallel::Serial serial;
  std::optional<parallel::Threads> exec;
  std::unique_ptr<DeviceRenderer> gpu;
  const AddedMethod* on_gpu = nullptr;  ///< that `gpu` draws
  std::uint64_t fits_gpu = 0;           ///< bytes that were found to fit
  // Made from the map that was drawn last.
  std::optional<Ceiling> ceiling;
  std::optional<Pyramid> pyramid;
};

TerrainRenderer::TerrainRenderer(TerrainRendererOptions options)
    : impl_("TerrainRenderer", in_memory([&] { return std::make_unique<Impl>(options); })) {}
TerrainRenderer::~TerrainRenderer() = default;
TerrainRenderer::TerrainRenderer(TerrainRenderer&&) noexcept = default;
TerrainRenderer& TerrainRenderer::operator=(TerrainRenderer&&) noexcept = default;

const TerrainRendererOptions& TerrainRenderer::options() const {
  return impl_->options;
}

TerrainStats TerrainRenderer::render(const Terrain& terrain, const TerrainCamera& given,
                                     const TerrainOptions& options, const TerrainTargets& targets,
                                     StopToken stop) {
  return parallel::in_turn(impl_->one_at_a_time, stop, [&] {
    check(options);
    check(given);
    if (options.classic && given.roll_rad != 0)
      reject("terrain: the classic picture knows no roll; leave one of them out");
    check_size(targets.color8, options.width, options.height, "terrain: the color8 target");
    check_size(targets.depth, options.width, options.height, "terrain: the depth target");
    check_apart(targets.color8, "terrain: the color8 target", targets.depth, "the depth target");
    TerrainStats stats;
    Stopwatch stopwatch(stats);
    stats.camera = given;
    const bool rolled = given.roll_rad != 0;
    DeviceChoice place =
        impl_->place(terrain, rolled ? upright_of(options, given).options : options, targets);
    stats.device = place.device;
    stats.device_why = std::move(place.why);
    stats.isa = stats.device == Device::threads ? impl_->isa : Isa::scalar;
    const std::optional<double> clearance = options.classic ? 10 : options.ground_clearance;
    if (clearance) stats.camera = above_ground(terrain, given, *clearance, options.tiling);
    impl_->memory.restart_peak();
    impl_->prepare(terrain, options, stats.device);
    stopwatch.lap("prepare");

    const Counts counts =
        rolled ? impl_->draw_rolled(terrain, options, stats.camera, targets, stats, stopwatch)
               : impl_->draw(terrain, options, stats.camera, nullptr, targets, stats, stopwatch);
    stats.samples = counts.samples;
    stats.visible = counts.visible;
    stats.peak_bytes += impl_->memory.peak() + (impl_->ceiling ? impl_->ceiling->bytes() : 0) +
                        (impl_->pyramid ? impl_->pyramid->bytes() : 0);
    stopwatch.lap("draw");
    return stats;
  });
}

}  // namespace rastrum::terrain
