// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench auto`: the choice of `auto` beside every fixed rasterizer × visibility, over
// scenes × sizes. The project's goal: within 1.25 × of the best one on every row.
#include <algorithm>
#include <array>
#include <vector>

#include "contest.hpp"
#include "peers/compare.hpp"
#include "peers/selection.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "stand_ins.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

constexpr double kGoal = 1.25;
/// Choices this much slower than the fastest have their first frame as only sample.
constexpr double kHopeless = 4;

/// Skips rows with more fragments, because `sorted` holds them all, 24 bytes each.
constexpr double kMostFragments = 150e6;

/// Rows beside the chosen scenes: few large triangles, many layers.
struct Extra {
  const char* name;
  int layers;  ///< the most fragments a pixel
  Mesh (*make)(Size);
};
constexpr std::array<Extra, 4> kExtras{
    {{"8 large triangles", 1,
      [](Size s) { return sized_triangles(s.width, s.height, 8, 4000, 40000, 1); }},
     {"400 large triangles", 8,
      [](Size s) { return sized_triangles(s.width, s.height, 400, 4000, 40000, 3); }},
     {"16 sheets, shuffled", 16,
      [](Size s) { return sheets(s.width, s.height, 16, 32, Order::random); }},
     {"64 sheets, front first", 64,
      [](Size s) { return sheets(s.width, s.height, 64, 16, Order::front_to_back); }}}};

struct Run {
  Grid grid{"",
            {"scene, size", "auto chose", "auto ms", "best fixed choice", "its ms", "auto ÷ best",
             "≤ 1.25", "why"},
            {}};
  Panel panel{"auto over the best fixed choice", {{"auto ÷ best", {}, 0}}};
  std::vector<std::string> places;
  nlohmann::json figures = nlohmann::json::array();
  bool right = true;
  double worst = 0;
};

void measure(Run& run, const std::string& row_name, const Subject& subject,
             const std::vector<Entrant>& entrants, const TableOptions& options) {
  progress(row_name);
  const std::vector<Result> results = contest(subject, entrants, options.plan(), kHopeless);
  const Result& chosen = results[0];
  const Result* best = nullptr;
  nlohmann::json all = nlohmann::json::object();
  for (const Result& r : results) {
    run.right = run.right && !r.wrong;
    all[r.name] = r.ran() ? nlohmann::json(r.median_ms()) : nlohmann::json(r.not_run);
    if (&r != &chosen && r.ran() && (best == nullptr || r.median_ms() < best->median_ms()))
      best = &r;
  }
  std::vector<std::string> row{row_name};
  double ratio = 0;
  if (!chosen.ran() || best == nullptr) {
    row.push_back("not run (" + (chosen.ran() ? "no fixed choice" : chosen.not_run) + ")");
  } else {
    ratio = median_ratio(chosen.timing, best->timing);
    run.worst = std::max(run.worst, ratio);
    row.insert(row.end(),
               {chosen.stats.rasterizer + " × " + chosen.stats.visibility,
                significant(chosen.median_ms()), best->name, significant(best->median_ms()),
                significant(ratio), ratio <= kGoal ? "yes" : "NO", chosen.stats.why});
  }
  run.grid.rows.push_back(std::move(row));
  run.places.push_back(std::to_string(run.places.size() + 1));
  run.panel.series[0].values.push_back(ratio);
  run.figures.push_back({{"row", row_name},
                         {"chosen", chosen.stats.rasterizer + " × " + chosen.stats.visibility},
                         {"why", chosen.stats.why},
                         {"ratio", ratio},
                         {"ms", all}});
}

}  // namespace

int run_auto(std::span<const std::string_view> arguments) {
  TableOptions options;
  Selection selection(peer_scenes(), {{1024, 1024}, {1920, 1080}, {4096, 4096}});
  OptionParser parser("auto", "`auto` against every fixed rasterizer × visibility.");
  selection.add_to(parser);
  if (const auto status = options.read(parser, arguments)) return *status;
  if (options.quick) {
    selection.set_sizes({{256, 256}});
    selection.set_scenes({procedural_scenes().front()});
  }
  selection.resolve();

  std::vector<Entrant> entrants{entrant(options, "auto")};
  for (const family::AxisInfo& rasterizer : family::rasterizer_axis())
    for (const family::AxisInfo& visibility : family::visibility_axis())
      if (rasterizer.name != "reference")
        entrants.push_back(entrant(options, rasterizer.name, visibility.name));

  Run run;
  const auto measure_row = [&](const std::string& name, const Mesh& mesh, Size size,
                               const Camera& camera) {
    measure(run, name + ", " + size_text(size),
            {mesh.view(), camera, size.width, size.height, &triangle_colors()}, entrants, options);
  };
  for (const SceneInfo& info : selection.scenes()) {
    const Mesh mesh = load(info);
    const Camera camera = whole_view(mesh);
    for (const Size size : selection.sizes())
      measure_row(std::string(info.name), mesh, size, camera);
  }
  for (const Extra& extra : kExtras)
    for (const Size size : selection.sizes())
      if (static_cast<double>(size.width) * size.height * extra.layers <= kMostFragments)
        measure_row(extra.name, extra.make(size), size, window_camera(size.width, size.height));

  Document document = options.document("auto", "`auto` against every fixed choice");
  document.notes.push_back(
      "One colour a triangle, " + options.here() +
      ". All choices take turns; the ratio is the median over rounds of `auto`'s time over the "
      "best fixed choice's of the same round. Choices more than " +
      significant(kHopeless, 1) +
      " times slower than the fastest in the frame that is checked are not timed further. Worst: " +
      significant(run.worst) + " (goal " + significant(kGoal) + ").");
  document.figures = std::move(run.figures);
  document.grids.push_back(std::move(run.grid));
  Plot plot;
  plot.title = "auto over the best fixed choice (a bar a row of the table)";
  plot.kind = Plot::Kind::bars;
  plot.log_y = false;
  plot.x_title = "row";
  plot.y_title = "ratio";
  plot.places = std::move(run.places);
  plot.panels.push_back(std::move(run.panel));
  document.plot = std::move(plot);
  publish(document, options.out);
  return run.right ? 0 : 1;
}

}  // namespace rastrum::bench
