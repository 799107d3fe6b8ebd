// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench paper2`: large triangles by both schedules of `binned` beside paper 2, section 3,
// and the balance of load on 64 simulated workers (the project's goal: at most 1.1 × the mean).
#include <vector>

#include <bench/contest.hpp>
#include <bench/cuda/rates.hpp>
#include <bench/peers/compare.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/stand_ins.hpp>
#include <bench/tables/comparison.hpp>
#include <bench/tables/options.hpp>
#include <papers/paper2/published.hpp>

namespace rastrum::bench {
namespace {

constexpr int kFrameWidth = 1920, kFrameHeight = 1080;
constexpr double kEvenLoad = 1.1;
constexpr std::string_view kMost = "most loaded of 64 workers", kWork = "work of 64 workers";

struct RandomTriangles {
  const char* name;
  int count;
  double least, most;  ///< fragments of a triangle
  int published;       ///< the paper's column, or −1
};
/// Paper 2 names only ranges; 400 is our addition. Very large is up to half the picture.
constexpr std::array<RandomTriangles, 4> kScenes{
    {{"8 large", 8, paper2::kLargeFragments, paper2::kVeryLargeFragments, 0},
     {"40 large", 40, paper2::kLargeFragments, paper2::kVeryLargeFragments, 1},
     {"400 large", 400, paper2::kLargeFragments, paper2::kVeryLargeFragments, -1},
     {"40 very large", 40, paper2::kVeryLargeFragments, 1e9, 2}}};

/// The rows of the paper's table that the schedules' figures go into.
enum PaperRow : std::size_t { kPersistent, kStoreBins, kRasterizeBins, kBoth };

/// The time of one stage of the frame.
Measured stage(const Result& result, std::string_view name) {
  Measured m;
  m.not_run = result.not_run;
  for (const auto& [stage_name, ms] : result.stages_ms)
    if (stage_name == name) m.value = ms;
  return m;
}

void add_load(const Result& result, const char* scene, Grid& grid, nlohmann::json& figures) {
  std::vector<std::string> row{scene, result.name};
  const std::uint64_t most = counter(result.stats, kMost), work = counter(result.stats, kWork);
  if (!result.ran() || work == 0) {
    row.push_back(result.ran() ? "not counted" : "not run (" + result.not_run + ")");
  } else {
    const double mean = static_cast<double>(work) / 64;
    const double ratio = static_cast<double>(most) / mean;
    row.insert(row.end(), {std::to_string(most), significant(mean), significant(ratio, 4),
                           ratio <= kEvenLoad ? "yes" : "NO"});
    figures.push_back({{"table", "load"},
                       {"row", scene},
                       {"schedule", result.name},
                       {"most", most},
                       {"mean", mean}});
  }
  grid.rows.push_back(std::move(row));
}

}  // namespace

int run_paper2(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("paper2", "Large triangles by both schedules of `binned` (paper 2).");
  options.add_device(parser);
  if (const auto status = options.read(parser, arguments)) return *status;
  const int width = options.size(kFrameWidth), height = options.size(kFrameHeight);
  const double scale = static_cast<double>(width) * height / (kFrameWidth * kFrameHeight);

  Document document = options.document("paper2", "Paper 2, section 3: large triangles");
  document.notes.push_back(
      "Random triangles of 4,000 to 40,000 px (large) and of more, up to half the picture (very "
      "large), at " +
      std::to_string(width) + " × " + std::to_string(height) +
      ", one colour each. The paper tells neither its picture's size nor its triangles. Ours: the "
      "whole frame from vertices to finished pixels, and of it the two stages of the same name.");
  Comparison c{"Time by schedule", "ms", "paper, GTX 1070 Ti", options.here(), "schedule", {}, {}};
  for (const auto& row : paper2::kTable) {
    c.rows.push_back(row_of(row));
    Comparison::Row& r = c.rows.back();
    const std::vector<Published> columns = std::move(r.published);
    r.published.clear();
    for (const RandomTriangles& s : kScenes)
      r.published.push_back(s.published < 0 ? Published{}
                                            : columns[static_cast<std::size_t>(s.published)]);
    r.ours.assign(kScenes.size(), {});
  }
  c.rows.push_back({"auto", "", {}, std::vector<Measured>(kScenes.size())});
  Grid load{"Coverage work of 64 simulated workers",
            {"scene", "schedule", "most", "mean", "most ÷ mean", "≤ 1.1"},
            {}};
  Grid phases{"Stages of a frame, ms", {"scene", "schedule", "stages"}, {}};

  std::vector<Entrant> entrants;
  for (const auto schedule : {family::Schedule::persistent, family::Schedule::two_stage}) {
    family::Tuning tuning;
    tuning.schedule = schedule;
    entrants.push_back(entrant(options, "binned", "auto", tuning));
    entrants.back().name = schedule == family::Schedule::persistent ? "persistent" : "two-stage";
  }
  entrants.push_back(entrant(options, "auto"));
  MachineLimits device;
  std::vector<Rates> rates;
  if (options.on_cuda()) {
    device = measure_device(options);
    document.notes.push_back(device_note(options, device));
    family::Tuning two_stage;
    two_stage.schedule = family::Schedule::two_stage;
    for (Entrant& e : device_entrants(options, entrant(options, "binned", "auto", two_stage))) {
      c.rows.push_back({e.name, "", {}, std::vector<Measured>(kScenes.size())});
      rates.emplace_back(e.name, "scene");
      entrants.push_back(std::move(e));
    }
  }
  bool right = true;
  for (std::size_t s = 0; s < kScenes.size(); ++s) {
    const RandomTriangles& scene = kScenes[s];
    progress(scene.name);
    c.columns.emplace_back(scene.name);
    const Mesh mesh =
        sized_triangles(width, height, scene.count, scene.least * scale, scene.most * scale, 1 + s);
    const Subject subject{mesh.view(), window_camera(width, height), width,
                          height,      &triangle_colors(),           options.on_cuda()};
    const std::vector<Result> results = contest(subject, entrants, options.plan());
    c.rows[kPersistent].ours[s] = measured_ms(results[0], subject, false);
    c.rows[kStoreBins].ours[s] = stage(results[1], "store bins");
    c.rows[kRasterizeBins].ours[s] = stage(results[1], "rasterize bins");
    c.rows[kBoth].ours[s] = measured_ms(results[1], subject, false);
    for (std::size_t i = 2; i < results.size(); ++i)
      c.rows[kBoth + i - 1].ours[s] = measured_ms(results[i], subject, false);
    for (std::size_t i = 0; i < rates.size(); ++i)
      rates[i].add(scene.name, "all", mesh.triangle_count(), results[3 + i].median_ms(),
                   floor_ms(mesh.triangle_count(),
                            static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height),
                            device, mesh.positions.size()));
    for (std::size_t i = 0; i < 2; ++i) {
      add_load(results[i], scene.name, load, document.figures);
      phases.rows.push_back({scene.name, results[i].name,
                             results[i].ran() ? times_text(results[i].stages_ms)
                                              : "not run (" + results[i].not_run + ")"});
    }
    right = right && all_right(results);
  }
  add(document, c);
  for (const Rates& r : rates) r.add_to(document);
  document.grids.push_back(std::move(load));
  document.grids.push_back(std::move(phases));
  document.plot = bars_of(c);
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
