// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench hashed` and `rastrum bench hiz`: sheets one behind the other, so that the depth
// complexity is a parameter.
#include <algorithm>
#include <vector>

#include "contest.hpp"
#include "peers/compare.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "stand_ins.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

constexpr int kCells = 48;  ///< quads along a sheet's side: 4,608 triangles

constexpr std::array<Order, 3> kOrders{Order::front_to_back, Order::random, Order::back_to_front};

struct Sheets {
  Mesh mesh;
  Subject subject;
};

/// `scene.subject` views `scene.mesh`.
void make_sheets(Sheets& scene, int size, int layers, Order order, bool quick) {
  scene.mesh = sheets(size, size, layers, quick ? 6 : kCells, order);
  scene.subject = {scene.mesh.view(), window_camera(size, size), size, size, &triangle_colors()};
}

}  // namespace

int run_hashed(std::span<const std::string_view> arguments) {
  TableOptions options;
  int size = 512;
  OptionParser parser("hashed", "Hashed against sorted visibility over depth complexity 1 to 64.");
  parser.add_option("--size", size, "edge of the picture in px (default: 512)")->range(8, 8192);
  if (const auto status = options.read(parser, arguments)) return *status;
  size = options.size(size);
  Document document =
      options.document("hashed", "Hashed against sorted fragments (paper 5, future work)");
  document.notes.push_back(
      "Wavy sheets that fill " + std::to_string(size) + " × " + std::to_string(size) +
      ", one behind the other, triangles shuffled; coverage by `scanline`, " + options.here() +
      ". Load factor: covered pixels over the table's slots. Ratios are medians of paired rounds.");
  Grid grid{"",
            {"depth complexity", "fragments", "sorted ms", "hashed ms", "sorted ÷ hashed",
             "sorted MB", "hashed MB", "slots", "load factor", "wins"},
            {}};
  Plot plot;
  plot.title = "Hashed against sorted";
  plot.note = "wavy sheets, shuffled; " + options.here();
  plot.x_title = "depth complexity";
  plot.y_title = "ms";
  Panel panel{"frame", {{"sorted", {}, 0}, {"hashed", {}, 1}}};
  const std::vector<Entrant> entrants{entrant(options, "scanline", "sorted"),
                                      entrant(options, "scanline", "hashed")};
  bool right = true;
  for (const int layers : {1, 2, 4, 8, 16, 32, 64}) {
    progress("depth complexity " + std::to_string(layers));
    Sheets scene;
    make_sheets(scene, size, layers, Order::random, options.quick);
    const std::vector<Result> results = contest(scene.subject, entrants, options.plan());
    const Result &sorted = results[0], &hashed = results[1];
    right = right && all_right(results);
    std::vector<std::string> row{std::to_string(layers)};
    const double ratio =
        sorted.ran() && hashed.ran() ? median_ratio(sorted.timing, hashed.timing) : 0;
    const std::uint64_t slots = counter(hashed.stats, "table slots");
    const double load =
        slots > 0 ? static_cast<double>(hashed.stats.pixels_covered) / static_cast<double>(slots)
                  : 0;
    row.push_back(sorted.ran() ? std::to_string(sorted.stats.fragments) : "");
    const auto ms = [](const Result& r) {
      return r.ran() ? significant(r.median_ms()) : "not run (" + r.not_run + ")";
    };
    const auto mb = [](const Result& r) { return r.ran() ? megabytes(r.stats.peak_bytes) : ""; };
    row.insert(row.end(),
               {ms(sorted), ms(hashed), ratio > 0 ? significant(ratio) : "", mb(sorted), mb(hashed),
                slots > 0 ? std::to_string(slots) : "", load > 0 ? significant(load) : "",
                ratio <= 0  ? ""
                : ratio > 1 ? "hashed"
                            : "sorted"});
    grid.rows.push_back(row);
    document.figures.push_back({{"depth_complexity", layers},
                                {"sorted_ms", sorted.median_ms()},
                                {"hashed_ms", hashed.median_ms()},
                                {"sorted_over_hashed", ratio},
                                {"slots", slots},
                                {"load_factor", load}});
    plot.places.push_back(std::to_string(layers));
    panel.series[0].values.push_back(or_gap(sorted.median_ms()));
    panel.series[1].values.push_back(or_gap(hashed.median_ms()));
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

int run_hiz(std::span<const std::string_view> arguments) {
  TableOptions options;
  int size = 1024;
  OptionParser parser("hiz", "The gain of hierarchical Z on depth complexity 1, 4, 16 and 64.");
  parser.add_option("--size", size, "edge of the picture in px (default: 1024)")->range(8, 8192);
  if (const auto status = options.read(parser, arguments)) return *status;
  size = options.size(size);
  Document document = options.document("hiz", "Hierarchical Z: time without over time with");
  document.notes.push_back("Wavy sheets that fill " + std::to_string(size) + " × " +
                           std::to_string(size) + ", one behind the other; " + options.here() +
                           ". Ratios are medians of paired rounds; above 1 it gains.");
  Grid grid{"", {"order, depth complexity"}, {}};
  Plot plot;
  plot.title = "Hierarchical Z: time without over time with";
  plot.x_title = "depth complexity";
  plot.y_title = "gain";
  plot.places = {"1", "4", "16", "64"};
  std::vector<std::string> names;
  std::vector<Entrant> entrants;
  for (const family::AxisInfo& info : family::rasterizer_axis()) {
    if (info.name == "reference") continue;
    names.push_back(info.name);
    grid.columns.push_back(info.name);
    for (const bool on : {false, true}) {
      entrants.push_back(entrant(options, info.name));
      entrants.back().options.hierarchical_z = on;
    }
  }
  bool right = true;
  for (const Order order : kOrders) {
    Panel panel{name(order), {}};
    for (std::size_t r = 0; r < names.size(); ++r)
      panel.series.push_back({names[r], {}, static_cast<int>(r)});
    for (const int layers : {1, 4, 16, 64}) {
      progress(std::string(name(order)) + ", " + std::to_string(layers));
      Sheets scene;
      make_sheets(scene, size, layers, order, options.quick);
      const std::vector<Result> results = contest(scene.subject, entrants, options.plan());
      std::vector<std::string> row{std::string(name(order)) + ", " + std::to_string(layers)};
      right = right && all_right(results);
      for (std::size_t r = 0; r < names.size(); ++r) {
        const Result &off = results[2 * r], &on = results[2 * r + 1];
        const bool both = off.ran() && on.ran();
        const double gain = both ? median_ratio(off.timing, on.timing) : 0;
        row.push_back(both ? significant(gain) + " (" + significant(on.median_ms()) + " ms)"
                           : "not run (" + (off.ran() ? on : off).not_run + ")");
        panel.series[r].values.push_back(or_gap(gain));
        nlohmann::json counters = nlohmann::json::object();
        for (const auto& [what, value] : on.stats.counters) counters[what] = value;
        document.figures.push_back({{"order", name(order)},
                                    {"depth_complexity", layers},
                                    {"rasterizer", names[r]},
                                    {"without_ms", off.median_ms()},
                                    {"with_ms", on.median_ms()},
                                    {"gain", gain},
                                    {"counters", counters}});
      }
      grid.rows.push_back(std::move(row));
    }
    plot.panels.push_back(std::move(panel));
  }
  document.grids.push_back(std::move(grid));
  document.plot = std::move(plot);
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
