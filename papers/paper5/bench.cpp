// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench paper5-table1` (with table 2's ratio) and `paper5-table3` (with figure 3): paper
// 5, section 5, beside its own method (`sorted`: rasterize, sort, select, write) and our default.
#include <algorithm>
#include <limits>
#include <vector>

#include <bench/contest.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/stand_ins.hpp>
#include <bench/tables/comparison.hpp>
#include <bench/tables/options.hpp>
#include <papers/paper5/bench_data.hpp>
#include <papers/paper5/published.hpp>

namespace rastrum::bench {
namespace {

using paper5::kDataSets;

/// The better of the paper's two CPU figures of a data set, frames a second.
double best_cpu(std::size_t data) {
  double best = 0;
  for (std::size_t r = 0; r < paper5::kCpuRows; ++r)
    best = std::max(best, paper5::kTable1[r].figures[data].value);
  return best;
}

/// Smoke tests print no goal.
std::string goal_text(double times, double goal, const TableOptions& options) {
  if (times <= 0) return "not run";
  std::string text = significant(times) + " ×";
  if (goal > 0 && !options.quick)
    text.append(times >= goal ? " (goal " : " (MISSED: goal ")
        .append(significant(goal, 2))
        .append(")");
  return text;
}

}  // namespace

int run_paper5_table1(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("paper5-table1",
                      "Paper 5, tables 1 and 2: frames a second by data set, at 10 × resolution.");
  if (const auto status = options.read(parser, arguments, true)) return *status;
  Document document =
      options.document("paper5-table1", "Paper 5, tables 1 and 2: frames a second by data set");
  document.notes.push_back(paper5_note(options) + " INTEL: 14 threads of a Xeon E5-2690 v4.");

  Comparison c{"Table 1: frames a second", "FPS", "paper", options.here(), "rasterizer", {}, {}};
  for (const auto& row : paper5::kTable1) {
    c.rows.push_back(row_of(row));
    c.rows.back().ours.clear();
  }
  const std::size_t first = c.rows.size();
  const std::vector<Entrant> entrants{entrant(options, "scanline", "sorted"),
                                      entrant(options, "auto")};
  for (const Entrant& e : entrants)
    c.rows.push_back({e.name, "", {}, std::vector<Measured>(kDataSets.size())});
  Grid goals{"Times the better CPU figure of the paper",
             {"data set", "paper's best CPU, FPS", "sorted alone", "default"},
             {}};
  std::vector<double> seconds(entrants.size());
  bool right = true;
  for (std::size_t d = 0; d < kDataSets.size(); ++d) {
    const auto& [data, goal] = kDataSets[d];
    progress(std::string(data.name));
    c.columns.emplace_back(data.name);
    const Paper5Scene scene = paper5_scene(data, paper5::kScale, options);
    document.notes.push_back(describe(data, scene));
    const std::vector<Result> results = contest(scene.subject(), entrants, options.plan());
    right = right && all_right(results);
    std::vector<double> times;
    for (std::size_t i = 0; i < results.size(); ++i) {
      c.rows[first + i].ours[d] = measured_fps(results[i], scene.subject());
      times.push_back(c.rows[first + i].ours[d].value / best_cpu(d));
      // An average without one of the data sets is undefined.
      seconds[i] += results[i].ran() ? results[i].median_ms() / 1000 / kDataSets.size()
                                     : std::numeric_limits<double>::quiet_NaN();
    }
    goals.rows.push_back({std::string(data.name), significant(best_cpu(d)),
                          goal_text(times[0], 1, options), goal_text(times[1], goal, options)});
  }
  add(document, c);
  document.grids.push_back(std::move(goals));

  Grid speedups{"Table 2: seconds on average over table 1, GPU over CPU",
                {"algorithm", "GPU, s", "CPU, s", "speedup"},
                {}};
  for (const auto& s : paper5::kTable2)
    speedups.rows.push_back({std::string(s.algorithm) + " — paper", significant(s.gpu_s, 2),
                             significant(s.cpu_s), significant(s.ratio)});
  for (std::size_t i = 0; i < entrants.size(); ++i)
    speedups.rows.push_back({entrants[i].name + " — " + options.here(), "not run (no GPU)",
                             seconds[i] > 0 ? significant(seconds[i]) : "not run (absent)",
                             "not run (no GPU)"});
  document.grids.push_back(std::move(speedups));
  document.plot = bars_of(c);
  publish(document, options.out);
  return right ? 0 : 1;
}

int run_paper5_table3(std::span<const std::string_view> arguments) {
  TableOptions options;
  int scale = 1;
  OptionParser parser("paper5-table3",
                      "Paper 5, table 3 and figure 3: Landshark by the number of threads.");
  parser.add_option("--scale", scale, "image scale (default: 1)")->range(1, 128);
  if (const auto status = options.read(parser, arguments, true)) return *status;
  Document document = options.document("paper5-table3", "Paper 5, table 3 and figure 3: threads");
  document.notes.push_back(
      paper5_note(options) +
      " The paper does not say at which image scale it measured; its times at 14 threads are a "
      "tenth of table 1's at scale 10, so scale 1 is taken unless --scale says otherwise.");
  progress("Landshark");
  const Paper5Scene scene = paper5_scene(paper5::kLandshark, scale, options);
  document.notes.push_back(describe(paper5::kLandshark, scene));

  // Each number of threads is a contender, so that all take turns.
  std::vector<Entrant> entrants;
  for (const char* rasterizer : {"scanline", "auto"})
    for (const auto& row : paper5::kTable3) {
      if (row.threads > TableOptions::cores()) continue;
      TableOptions with = options;
      with.threads = row.threads;
      entrants.push_back(entrant(with, rasterizer,
                                 std::string_view(rasterizer) == "scanline" ? "sorted" : "auto"));
      entrants.back().name += " " + std::to_string(row.threads);
    }
  const std::vector<Result> results = contest(scene.subject(), entrants, options.plan());

  Comparison c{"Table 3: seconds by threads", "s", "paper, Xeon E5-2690 v4", "here", "threads",
               {"scanline × sorted", "auto"}, {}};
  Grid cost{
      "Cost in core-seconds and speedup over one thread",
      {"threads", "paper: cost", "speedup", "sorted: cost", "speedup", "auto: cost", "speedup"},
      {}};
  const auto result_of = [&](std::size_t column, std::size_t row) -> const Result* {
    const std::size_t ran = entrants.size() / 2;
    return row < ran ? &results[column * ran + row] : nullptr;
  };
  for (std::size_t r = 0; r < paper5::kTable3.size(); ++r) {
    const paper5::Scaling& p = paper5::kTable3[r];
    Comparison::Row row{"", std::to_string(p.threads), {{p.seconds}, {}}, {{}, {}}};
    std::vector<std::string> cells{row.at, significant(p.cost_core_s), significant(p.speedup)};
    for (std::size_t column = 0; column < 2; ++column) {
      const Result* result = result_of(column, r);
      Measured& m = row.ours[column];
      if (result == nullptr) {
        m.not_run = std::to_string(TableOptions::cores()) + " cores";
      } else {
        m = measured_ms(*result, scene.subject(), false);
        m.value /= 1000;
      }
      const double one = result == nullptr ? 0 : result_of(column, 0)->median_ms() / 1000;
      const auto or_not = [&](double v) { return m.value > 0 ? significant(v) : "not run"; };
      cells.push_back(or_not(m.value * p.threads));
      cells.push_back(or_not(one / m.value));
    }
    c.rows.push_back(std::move(row));
    cost.rows.push_back(std::move(cells));
  }
  add(document, c);
  document.grids.push_back(std::move(cost));

  Grid phases{
      "Figure 3: cost of each phase of `sorted` (threads × time) over its cost with one "
      "thread. The paper draws its figures without printing them.",
      {"phase", "one thread, ms"},
      {}};
  const Result& serial = results.front();
  for (std::size_t r = 1; result_of(0, r) != nullptr; ++r)
    phases.columns.push_back(std::to_string(paper5::kTable3[r].threads) + " threads");
  for (const auto& [name, ms] : serial.stages_ms) {
    std::vector<std::string> cells{name, significant(ms)};
    for (std::size_t r = 1; result_of(0, r) != nullptr; ++r)
      for (const auto& [other, other_ms] : result_of(0, r)->stages_ms)
        if (other == name) cells.push_back(significant(other_ms * paper5::kTable3[r].threads / ms));
    document.figures.push_back({{"table", "figure 3"}, {"phase", name}, {"cells", cells}});
    phases.rows.push_back(std::move(cells));
  }
  if (!serial.ran()) phases.rows.push_back({"all", "not run (" + serial.not_run + ")"});
  document.grids.push_back(std::move(phases));
  document.plot = lines_of(c, "threads");
  document.plot->x = {};
  for (const auto& row : paper5::kTable3)
    document.plot->x.push_back(static_cast<double>(row.threads));
  document.plot->log_x = true;
  publish(document, options.out);
  return all_right(results) ? 0 : 1;
}

}  // namespace rastrum::bench
