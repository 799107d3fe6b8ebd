#include <rastrum/terrain/renderer.hpp>

#include <optional>
#include <string>
#include <utility>

#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {

struct TerrainRenderer::Impl {
  explicit Impl(TerrainOptions given)
      : options(std::move(given)),
        isa(options.isa.value_or(available_isas().back())),
        pool(memory),
        serial(&memory) {
    if (options.device == Device::threads) exec.emplace(options.threads, &memory);
  }
  TerrainOptions options;
  Isa isa;
  MemoryAccount memory;
  BlockPool pool;
  parallel::Serial serial;
  std::optional<parallel::Threads> exec;
  std::optional<Ceiling> ceiling;
  std::optional<Pyramid> pyramid;  ///< of the map that was drawn last
};

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
  const auto fits = [&](const auto& view) {
    return view.empty() || (view.width == options.width && view.height == options.height);
  };
  if (!fits(targets.color8) || !fits(targets.depth))
    throw Error(Errc::invalid_argument, "terrain: the targets are not " +
                                            std::to_string(options.width) + "x" +
                                            std::to_string(options.height));
  TerrainStats stats;
  stats.camera = given;
  const std::optional<double> clearance = options.classic ? 10 : options.ground_clearance;
  if (clearance) stats.camera = above_ground(terrain, given, *clearance, options.tiling);

  if (terrain.is_map() && impl_->exec && !(impl_->ceiling && impl_->ceiling->is_of(terrain)))
    impl_->ceiling.emplace(terrain.heights());

  Counts counts;
  if (options.classic) {
    counts = impl_->exec && terrain.is_map()
                 ? draw_classic(*impl_->exec, impl_->isa, impl_->pool, terrain, *impl_->ceiling,
                                options, stats.camera, targets)
                 : draw_classic_reference(terrain, options, stats.camera, targets);
  } else {
    const Setup setup = set_up(options, stats.camera, terrain);
    Samples samples{setup, terrain, {}, nullptr};
    if (terrain.is_map()) {
      const bool whole = options.filter == Filter::mip;
      if (!impl_->pyramid || !impl_->pyramid->is_of(terrain, whole))
        impl_->pyramid.emplace(terrain.heights(), terrain.colors(), whole);
      samples.map = MapView(*impl_->pyramid, options, setup);
      samples.ceiling = impl_->ceiling ? &*impl_->ceiling : nullptr;
    }
    stats.slices = setup.slices.size();
    if (options.method == Method::words)
      counts = impl_->exec ? draw_words(*impl_->exec, samples, targets)
                           : draw_words(impl_->serial, samples, targets);
    else
      counts = impl_->exec ? draw_fast(*impl_->exec, impl_->isa, impl_->pool, samples, targets)
                           : draw_reference(samples, targets);
  }
  stats.samples = counts.samples;
  stats.visible = counts.visible;
  return stats;
}

}  // namespace rastrum::terrain
