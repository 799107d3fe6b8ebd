// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench terrain`: the cost of smooth near ground. A map with sharp shadows at 1920 × 1080
// by each filter, from near the ground and from above. Each picture is compared with plain code's
// on one thread before the timing.
#include <algorithm>
#include <string>
#include <vector>

#include <rastrum/digest.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "measure.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

constexpr int kSide = 1024;

terrain::Terrain lit_map() {
  const terrain::HeightFunction noise = terrain::named_function("noise");
  terrain::HeightMap map;
  map.heights = Image<float>(kSide, kSide);
  std::vector<double> xs(kSide), ys(kSide);
  for (int x = 0; x < kSide; ++x) xs[static_cast<std::size_t>(x)] = x + 0.5;
  for (int y = 0; y < kSide; ++y) {
    std::fill(ys.begin(), ys.end(), y + 0.5);
    noise(xs.data(), ys.data(), xs.size(), &map.heights(0, y));
  }
  map.colors = terrain::lit_colors(
      map, {.sun = {250, 20}, .shadows = terrain::Shadows::sharp, .hill_shading = true});
  return terrain::Terrain(std::move(map));
}

}  // namespace

int run_terrain(std::span<const std::string_view> arguments) {
  using terrain::MapFilter;
  TableOptions options;
  OptionParser parser("terrain", "A map by each filter at 1920 × 1080.");
  if (const auto status = options.read(parser, arguments)) return *status;
  Document document = options.document("terrain", "A map with sharp shadows by each filter");
  const int width = options.size(1920), height = options.size(1080);
  document.notes.push_back(std::to_string(width) + " × " + std::to_string(height) + ", " +
                           options.here() +
                           ", ms of a frame; bilinear in steps as long as a pixel is high, as the "
                           "program takes them, and in steps of 1 and more, as the others.");
  Grid grid{"", {"from", "none", "mip", "bilinear, step 1", "bilinear", "bilinear ÷ none"}, {}};
  Plot plot = options.plot(document, "from", "ms");
  plot.kind = Plot::Kind::bars;
  Panel panel{"a frame",
              {{"none", {}, 0}, {"mip", {}, 1}, {"bilinear, step 1", {}, 2}, {"bilinear", {}, 3}}};
  const terrain::Terrain map = lit_map();
  terrain::TerrainRenderer renderer({.threads = options.threads}),
      reference({.device = Device::serial});
  bool right = true;
  struct View {
    const char* name;
    double above, horizon;  ///< above the ground, cells; of the picture's height
  };
  for (const View& view : {View{"near the ground", 4, 0.1}, View{"above", 150, 0.2}}) {
    struct Way {
      MapFilter filter;
      double step;
    };
    constexpr Way kWays[] = {{MapFilter::none, 1},
                             {MapFilter::mip, 1},
                             {MapFilter::bilinear, 1},
                             {MapFilter::bilinear, 0}};
    Image<Rgba8> color(width, height), plain(width, height);
    std::vector<terrain::TerrainOptions> frames;
    terrain::TerrainCamera camera{.x = 512.3, .y = 700.6, .altitude = 0};
    camera.horizon_px = view.horizon * height;
    for (const Way& way : kWays) {
      terrain::TerrainOptions frame;
      frame.width = width;
      frame.height = height;
      frame.filter = way.filter;
      frame.step = way.step;
      frame.ground_clearance = view.above;
      frames.push_back(frame);
      (void)renderer.render(map, camera, frame, {.color8 = color});
      (void)reference.render(map, camera, frame, {.color8 = plain});
      right = right && digest(color.view()) == digest(plain.view());
    }
    std::vector<Contender> contenders;
    for (std::size_t i = 0; i < frames.size(); ++i)
      contenders.push_back({panel.series[i].name, [&, i] {
                              (void)renderer.render(map, camera, frames[i], {.color8 = color});
                            }});
    const std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
    std::vector<std::string> row{view.name};
    for (std::size_t i = 0; i < timings.size(); ++i) {
      row.push_back(significant(timings[i].median_ms()));
      panel.series[i].values.push_back(timings[i].median_ms());
      document.figures.push_back(
          {{"from", view.name}, {"filter", timings[i].name}, {"ms", timings[i].median_ms()}});
    }
    row.push_back(significant(median_ratio(timings[3], timings[0])));
    plot.places.emplace_back(view.name);
    grid.rows.push_back(std::move(row));
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
