#include <rastrum/terrain/renderer.hpp>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/roll.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace {

/// Adds the stages of a frame, one after the other.
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
  explicit Impl(TerrainOptions given)
      : options(std::move(given)),
        isa(options.isa.value_or(available_isas().back())),
        pool(memory),
        serial(&memory) {
    options.device = choose_device(options.device, false).device;
    if (options.device == Device::threads) exec.emplace(options.threads, &memory);
  }

  void prepare(const Terrain& terrain);
  Counts draw(const Terrain& terrain, const TerrainOptions& how, const TerrainCamera& camera,
              const TerrainTargets& targets, TerrainStats& stats);
  Counts draw_rolled(const Terrain& terrain, const TerrainCamera& camera,
                     const TerrainTargets& targets, TerrainStats& stats);

  TerrainOptions options;
  Isa isa;
  MemoryAccount memory;
  BlockPool pool;
  parallel::Serial serial;
  std::optional<parallel::Threads> exec;
  // Of the map that was drawn last.
  std::optional<Ceiling> ceiling;
  std::optional<Pyramid> pyramid;
};

/// What is computed once a map.
void TerrainRenderer::Impl::prepare(const Terrain& terrain) {
  if (!terrain.is_map()) return;
  if (exec && !(ceiling && ceiling->is_of(terrain))) ceiling.emplace(terrain.heights());
  const bool whole = options.filter == Filter::mip;
  if (!(pyramid && pyramid->is_of(terrain, whole)))
    pyramid.emplace(terrain.heights(), terrain.colors(), whole);
}

Counts TerrainRenderer::Impl::draw(const Terrain& terrain, const TerrainOptions& how,
                                   const TerrainCamera& camera, const TerrainTargets& targets,
                                   TerrainStats& stats) {
  if (how.classic) {
    if (exec && terrain.is_map())
      return draw_classic(*exec, isa, pool, terrain, *ceiling, how, camera, targets);
    return draw_classic_reference(terrain, how, camera, targets);
  }
  const Setup setup = set_up(how, camera, terrain);
  stats.slices = setup.slices.size();
  Samples samples{{setup, {}}, terrain, ceiling ? &*ceiling : nullptr};
  if (terrain.is_map()) samples.map = MapView(*pyramid, how, setup);
  if (how.method == Method::words)
    return exec ? draw_words(*exec, samples, targets) : draw_words(serial, samples, targets);
  return exec ? draw_fast(*exec, isa, pool, samples, targets) : draw_reference(samples, targets);
}

Counts TerrainRenderer::Impl::draw_rolled(const Terrain& terrain, const TerrainCamera& camera,
                                          const TerrainTargets& targets, TerrainStats& stats) {
  const Upright upright = upright_of(options, camera);
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
  const Counts counts = draw(terrain, upright.options, upright.camera, whole, stats);
  const auto row = [&](std::size_t y) {
    if (!colors.empty())
      roll_row(whole.color8, camera.roll_rad, static_cast<int>(y), targets.color8);
    if (!depth.empty()) roll_row(whole.depth, camera.roll_rad, static_cast<int>(y), targets.depth);
  };
  const auto rows = static_cast<std::size_t>(options.height);
  if (exec)
    parallel::for_each_index(*exec, rows, row);
  else
    parallel::for_each_index(serial, rows, row);
  stats.peak_bytes += colors.pixels().size_bytes() + depth.pixels().size_bytes();
  return counts;
}

TerrainRenderer::TerrainRenderer(TerrainOptions options) {
  check(options);
  impl_ = std::make_unique<Impl>(std::move(options));
}
TerrainRenderer::~TerrainRenderer() = default;
TerrainRenderer::TerrainRenderer(TerrainRenderer&&) noexcept = default;
TerrainRenderer& TerrainRenderer::operator=(TerrainRenderer&&) noexcept = default;

const TerrainOptions& TerrainRenderer::options() const {
  return impl_->options;
}

TerrainStats TerrainRenderer::render(const Terrain& terrain, const TerrainCamera& given,
                                     const TerrainTargets& targets) {
  const TerrainOptions& options = impl_->options;
  check(given);
  if (options.classic && given.roll_rad != 0)
    throw Error(Errc::invalid_argument,
                "terrain: the classic picture knows no roll; leave one of them out");
  const auto fits = [&](const auto& view) {
    return view.empty() || (view.width == options.width && view.height == options.height);
  };
  if (!fits(targets.color8) || !fits(targets.depth))
    throw Error(Errc::invalid_argument,
                std::string("terrain: the targets are not ")
                    .append(std::to_string(options.width) + "x" + std::to_string(options.height)));
  TerrainStats stats;
  Stopwatch stopwatch(stats);
  stats.isa = options.device == Device::threads ? impl_->isa : Isa::scalar;
  stats.camera = given;
  const std::optional<double> clearance = options.classic ? 10 : options.ground_clearance;
  if (clearance) stats.camera = above_ground(terrain, given, *clearance, options.tiling);
  impl_->memory.restart_peak();
  impl_->prepare(terrain);
  stopwatch.lap("prepare");

  const Counts counts = given.roll_rad != 0
                            ? impl_->draw_rolled(terrain, stats.camera, targets, stats)
                            : impl_->draw(terrain, options, stats.camera, targets, stats);
  stats.samples = counts.samples;
  stats.visible = counts.visible;
  stats.peak_bytes += impl_->memory.peak() + (impl_->ceiling ? impl_->ceiling->bytes() : 0) +
                      (impl_->pyramid ? impl_->pyramid->bytes() : 0);
  stopwatch.lap("draw");
  return stats;
}

}  // namespace rastrum::terrain
