// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper3/shadow_times.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <rastrum/terrain_light.hpp>

#include <bench/measure.hpp>
#include <bench/report.hpp>
#include <papers/paper3/published.hpp>

namespace rastrum::bench {
namespace {

using terrain::March;
using terrain::ShadowOptions;
using terrain::Sun;

/// Heights in cells: half of the hills' 0 to 200.
Image<float> tiled_map(const Image<float>& heights, int width, int height) {
  Image<float> map(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      map(x, y) = heights(x % heights.width(), y % heights.height()) / 2;
  return map;
}

/// The ways to find shadows; a device's come last.
constexpr const char* kWays[] = {"march", "sharp", "march, cuda", "sharp, cuda"};

struct ShadowTimes {
  std::vector<Timing> timings;  ///< one for each of kWays that ran; empty if `right` is false
  double hidden = 0;            ///< share of the cells in sharp shadow
  bool right = true;            ///< the device's shadows equal the threads'
};

ShadowTimes time_shadows(const TableOptions& options, int threads, const Image<float>& map,
                         const Sun& sun, const March& march) {
  struct Shadows {
    ShadowOptions how;
    Image<std::uint16_t> counts{};
    Image<std::uint8_t> dark{};
  };
  std::vector<Shadows> by{{{.threads = threads}}};
  if (options.on_cuda()) by.push_back({{.device = Device::cuda, .threads = threads}});
  std::vector<Contender> contenders;
  for (Shadows& s : by) {
    const std::size_t way = contenders.size();
    contenders.push_back(
        {kWays[way], [&] { s.counts = hidden_samples(map.view(), sun, march, s.how); }});
    contenders.push_back({kWays[way + 1], [&] { s.dark = sharp_shadows(map.view(), sun, s.how); }});
  }
  if (options.on_cuda()) {
    for (const Contender& c : contenders) c.frame();
    if (!std::ranges::equal(by[0].counts.pixels(), by[1].counts.pixels()) ||
        !std::ranges::equal(by[0].dark.pixels(), by[1].dark.pixels()))
      return {{}, 0, false};
  }
  std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
  const auto cells = by[0].dark.pixels();
  const auto hidden = std::ranges::count(cells, std::uint8_t{1});
  return {std::move(timings), static_cast<double>(hidden) / static_cast<double>(cells.size())};
}

void record(Document& document, const ShadowTimes& times, const Image<float>& map, const Sun& sun,
            const March& march, int threads) {
  document.figures.push_back({{"table", "shadows"},
                              {"width", map.width()},
                              {"height", map.height()},
                              {"samples", march.steps},
                              {"azimuth", sun.azimuth_deg},
                              {"elevation", sun.elevation_deg},
                              {"threads", threads},
                              {"hidden", times.hidden}});
  constexpr const char* kNames[] = {"march", "sharp", "device_march", "device_sharp"};
  for (std::size_t i = 0; i < times.timings.size(); ++i)
    document.figures.back()[kNames[i]] = to_json(times.timings[i]);
}

/// Figures 6.7 and 6.8. Returns false if a device's shadows are wrong.
bool over_q_and_samples(const TableOptions& options, const Image<float>& heights,
                        Document& document) {
  Grid grid{"Figures 6.7 and 6.8: shadows, ms, all threads (sharp takes no samples)",
            {"what grows", "method"},
            {}};
  std::vector<int> sizes(paper3::kShadowSizes.begin(), paper3::kShadowSizes.end());
  if (options.quick) sizes.resize(2);
  for (const int n : sizes) grid.columns.push_back(std::to_string(n));
  for (const bool grows_q : {true, false}) {
    progress(grows_q ? "shadows by q" : "shadows by d_c");
    const std::string what = grows_q ? "q (r = 128, d_c = 32)" : "d_c (q = r = 128)";
    std::vector<std::vector<std::string>> rows;
    for (std::size_t way = 0; way < (options.on_cuda() ? 4U : 2U); ++way)
      rows.push_back({what, kWays[way]});
    for (const int n : sizes) {
      const Image<float> map =
          tiled_map(heights, grows_q ? n : paper3::kShadowEdge, paper3::kShadowEdge);
      const March how{1024, grows_q ? paper3::kShadowSamples : n};
      const ShadowTimes times = time_shadows(options, options.threads, map, {}, how);
      if (!times.right) {
        document.notes.push_back("**Shadows at " + what + " = " + std::to_string(n) +
                                 ": the device's are not the threads'; nothing was timed.**");
        return false;
      }
      for (std::size_t way = 0; way < rows.size(); ++way)
        rows[way].push_back(significant(times.timings[way].median_ms()));
      record(document, times, map, {}, how, options.threads);
    }
    grid.rows.insert(grid.rows.end(), rows.begin(), rows.end());
  }
  document.grids.push_back(std::move(grid));
  return true;
}

bool over_suns(const TableOptions& options, const Image<float>& heights, Document& document) {
  const int edge = options.size(1024);
  const Image<float> map = tiled_map(heights, edge, edge);
  const std::string size = std::to_string(edge);
  Grid grid{"Sharp shadows beside the march of 256 samples, " + size + "×" + size +
                " cells, 100 of relief, one thread: march / sharp (ms of sharp; part in shadow)",
            {"sun's elevation"},
            {}};
  const std::vector<double> azimuths =
      options.quick ? std::vector<double>{315} : std::vector<double>{0, 20, 45, 70, 90, 200, 315};
  for (const double azimuth : azimuths)
    grid.columns.push_back("azimuth " + significant(azimuth) + "°");
  for (const double elevation : {10.0, 35.0, 60.0}) {
    progress("shadows by the sun, " + significant(elevation) + "° high");
    std::vector<std::string> row{significant(elevation) + "°"};
    for (const double azimuth : azimuths) {
      const Sun sun{azimuth, elevation};
      const ShadowTimes times = time_shadows(options, 1, map, sun, {});
      if (!times.right) {
        document.notes.push_back("**Shadows of a sun at " + significant(azimuth) +
                                 "°: the device's are not the threads'; nothing was timed.**");
        return false;
      }
      const Timing &marched = times.timings[0], &sharp = times.timings[1];
      row.push_back(significant(median_ratio(marched, sharp), 2) + " (" +
                    significant(sharp.median_ms()) + "; " + significant(100 * times.hidden, 2) +
                    " %)");
      record(document, times, map, sun, {}, 1);
    }
    grid.rows.push_back(std::move(row));
  }
  document.grids.push_back(std::move(grid));
  return true;
}

}  // namespace

bool add_shadow_times(const TableOptions& options, const Image<float>& heights,
                      Document& document) {
  return over_q_and_samples(options, heights, document) && over_suns(options, heights, document);
}

}  // namespace rastrum::bench
