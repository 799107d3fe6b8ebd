// SPDX-License-Identifier: BSD-3-Clause
// The tables of `rastrum bench transparency`, with the figures that paper 4 publishes.
#include <papers/paper4/bench/tables.hpp>

#include <algorithm>

#include <bench/report.hpp>
#include <papers/paper4/published.hpp>

namespace rastrum::bench {
namespace {

/// A goal: how many times faster than a peer our way has to be.
struct Goal {
  Peer peer;
  std::size_t technique;
  double times;
  const char* name;
};
constexpr std::array<Goal, 5> kGoals{{{kGlUnsorted, kUnsorted, 8, "llvmpipe unsorted ÷ unsorted"},
                                      {kGlUnsorted, kExact, 5, "llvmpipe unsorted ÷ exact"},
                                      {kGlLists, kExact, 10, "llvmpipe lists ÷ exact"},
                                      {kGlPeeling, kExact, 50, "llvmpipe peeling ÷ exact"},
                                      {kVtkPeeling, kExact, 50, "VTK peeling ÷ exact"}}};
constexpr double kOverUnsortedAverage = 2, kOverUnsortedWorst = 3;

std::string title(const TransparencyRow& row) {
  return row.scene + ", " + size_text(row.size);
}

std::string not_run(const Lap& lap) {
  return "not run (" + lap.not_run + ")";
}

std::string ms(const Lap& lap) {
  if (!lap.ran()) return not_run(lap);
  return (lap.at_least ? "> " : "") + significant(lap.timing.median_ms());
}

/// a over b, where a may be a lower bound.
std::string times(const Lap& a, const Lap& b) {
  const double r = ratio(a, b);
  return r > 0 ? (a.at_least ? "> " : "") + significant(r) : "";
}

std::string percent(double share) {
  return share <= 0 ? "0" : significant(100 * share, 2);
}

/// The mean and the largest of the values above 0, as text.
struct Summary {
  double sum = 0, worst = 0;
  int count = 0;

  void add(double value) {
    if (!(value > 0)) return;
    sum += value;
    worst = std::max(worst, value);
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
};

/// Adds rows for scenes whose files are missing.
void add_absent(Grid& grid, std::span<const std::string> absent) {
  for (const std::string& scene : absent) grid.rows.push_back({scene, "not run: no file"});
}

/// The stage that takes most of a frame, and its share.
std::string longest_stage(const FrameStats& stats) {
  const auto ms = stages_ms(stats);
  const auto longest = std::ranges::max_element(ms, {}, [](const auto& s) { return s.second; });
  if (longest == ms.end()) return "";
  return longest->first + " " + significant(100 * longest->second / stats.frame_ms, 2) + " %";
}

Grid times_grid(std::span<const TransparencyRow> rows) {
  Grid grid{
      "### Time\n\nms a frame. The floor: positions, normals and indices read once and pixels "
      "written once, or every fragment covered, shaded and blended; whichever takes longer.",
      {"scene, size", "triangles", "fragments", "deepest", "unsorted", "exact", "exact ÷ unsorted",
       "its floor", "binds", "exact ÷ floor", "most time in", "goals missed"},
      {}};
  Summary over_unsorted;
  for (const TransparencyRow& row : rows) {
    const Lap &exact = row.ours[kExact], &unsorted = row.ours[kUnsorted];
    over_unsorted.add(ratio(exact, unsorted));
    const double floor_ms = row.floor.ms();
    grid.rows.push_back({title(row), std::to_string(row.work.triangles),
                         std::to_string(row.work.fragments), std::to_string(row.deepest),
                         ms(unsorted), ms(exact), times(exact, unsorted), significant(floor_ms),
                         std::string(row.floor.binds()),
                         exact.ran() ? significant(exact.timing.median_ms() / floor_ms) : "",
                         exact.ran() ? longest_stage(exact.stats) : "", missed_goals(row)});
  }
  if (over_unsorted.count > 0)
    grid.rows.push_back({"average (goal ≤ 2)", "", "", "", "", "",
                         significant(over_unsorted.mean()) +
                             (over_unsorted.mean() <= kOverUnsortedAverage ? "" : " MISSED")});
  return grid;
}

Grid peers_grid(std::span<const TransparencyRow> rows) {
  Grid grid{"### Peers\n\nms a frame, and the peer's time over ours of the same rounds.",
            {"scene, size", "llvmpipe unsorted", "÷ unsorted", "÷ exact", "llvmpipe lists",
             "÷ exact", "llvmpipe peeling", "passes", "÷ exact", "VTK peeling", "÷ exact"},
            {}};
  for (const TransparencyRow& row : rows) {
    const Lap &exact = row.ours[kExact], &unsorted = row.ours[kUnsorted];
    const auto& p = row.peers;
    std::string passes;
    if (p[kGlPeeling].ran())
      passes = (p[kGlPeeling].at_least ? "> " : "") + std::to_string(p[kGlPeeling].passes);
    grid.rows.push_back({title(row), ms(p[kGlUnsorted]), times(p[kGlUnsorted], unsorted),
                         times(p[kGlUnsorted], exact), ms(p[kGlLists]), times(p[kGlLists], exact),
                         ms(p[kGlPeeling]), passes, times(p[kGlPeeling], exact), ms(p[kVtkPeeling]),
                         times(p[kVtkPeeling], exact)});
  }
  return grid;
}

Grid memory_grid(std::span<const TransparencyRow> rows) {
  Grid grid{
      "### Memory\n\nPeak scratch of ours beside what per-pixel lists take: 16 bytes a fragment "
      "and 4 a pixel. Ours holds the set-up triangles and their bins too, which an opaque "
      "frame also has; what exact takes beyond that are its layers. MB of 10⁶ bytes.",
      {"scene, size", "fragments", "exact", "unsorted", "opaque", "lists", "exact ÷ lists",
       "layers ÷ lists"},
      {}};
  for (const TransparencyRow& row : rows) {
    const Lap& exact = row.ours[kExact];
    const auto scratch = [](const Lap& lap) {
      return lap.ran() ? megabytes(lap.stats.peak_bytes) : not_run(lap);
    };
    const auto over_lists = [&](std::uint64_t bytes) {
      return significant(static_cast<double>(bytes) / static_cast<double>(row.list_bytes()));
    };
    std::vector<std::string> cells{title(row),
                                   std::to_string(row.work.fragments),
                                   scratch(exact),
                                   scratch(row.ours[kUnsorted]),
                                   megabytes(row.opaque_bytes),
                                   megabytes(row.list_bytes())};
    if (exact.ran()) {
      const std::uint64_t bytes = exact.stats.peak_bytes;
      cells.push_back(over_lists(bytes));
      cells.push_back(over_lists(bytes - std::min(bytes, row.opaque_bytes)));
    }
    grid.rows.push_back(std::move(cells));
  }
  return grid;
}

Grid techniques_grid(std::span<const TransparencyRow> rows) {
  Grid grid{
      "### Technique by technique\n\nErrors against exact, over black, at the pixels that "
      "something covers; worst: the largest difference of a channel at any pixel.",
      {"scene, size: technique", "ms", "÷ unsorted", "paper 4 (÷ unsorted)", "scratch MB", "RMSE",
       "PSNR dB", "worst"},
      {}};
  for (const TransparencyRow& row : rows)
    for (const Lap& lap : row.ours) {
      std::vector<std::string> cells{title(row) + ": " + lap.name, ms(lap)};
      if (lap.ran()) {
        const auto found = std::ranges::find(paper4::kOthers, lap.name, &paper4::Other::technique);
        std::string published =
            found != paper4::kOthers.end() ? shortest(found->over_unsorted) : "";
        if (lap.name == kTechniques[kFilter3].name)
          published = shortest(paper4::kOverUnsorted.average);
        const bool same = lap.error.rmse == 0;
        cells.insert(cells.end(),
                     {times(lap, row.ours[kUnsorted]), published, megabytes(lap.stats.peak_bytes),
                      same ? "0" : significant(lap.error.rmse, 2),
                      same ? "∞" : significant(lap.error.psnr()),
                      lap.error.worst == 0 ? "0" : significant(lap.error.worst, 2)});
      }
      grid.rows.push_back(std::move(cells));
    }
  return grid;
}

Grid errors_grid(std::span<const TransparencyRow> rows) {
  Grid grid{
      "### Wrong pixels of the filters\n\nPixels blended in another order than exact's, in "
      "percent of the picture (paper 4: of the same scene from its own cameras, where it is "
      "published).",
      {"scene, size"},
      {}};
  for (const int filter : paper4::kFilters) {
    grid.columns.push_back("filter " + std::to_string(filter) + ", %");
    grid.columns.push_back("pixels");
    grid.columns.push_back("paper 4, %");
  }
  const auto published = [](double value) { return value > 0 ? shortest(value) : ""; };
  std::array<Summary, paper4::kFilters.size()> average;
  for (const TransparencyRow& row : rows) {
    std::vector<std::string> cells{title(row)};
    const auto paper =
        std::ranges::find(paper4::kWrongPixels, row.scene, &paper4::WrongPixels::scene);
    for (std::size_t i = 0; i < paper4::kFilters.size(); ++i) {
      const Lap& lap = row.ours[kFilter3 + i];
      const double share =
          static_cast<double>(lap.wrong_pixels) / static_cast<double>(row.work.pixels);
      cells.push_back(lap.ran() ? percent(share) : not_run(lap));
      cells.push_back(lap.ran() ? std::to_string(lap.wrong_pixels) : "");
      cells.push_back(paper != paper4::kWrongPixels.end() ? published(paper->percent[i]) : "");
      if (lap.ran()) {
        average[i].sum += share;
        ++average[i].count;
      }
    }
    grid.rows.push_back(std::move(cells));
  }
  std::vector<std::string> cells{"average"};
  for (std::size_t i = 0; i < average.size(); ++i) {
    cells.push_back(average[i].count > 0 ? percent(average[i].mean()) : "");
    cells.push_back("");
    cells.push_back(published(paper4::kAverage.percent[i]));
  }
  grid.rows.push_back(std::move(cells));
  for (const paper4::WrongPixels& paper : paper4::kWrongPixels)
    if (std::ranges::find(rows, paper.scene, &TransparencyRow::scene) == rows.end()) {
      std::vector<std::string> line{std::string(paper.scene) + " (not drawn here)"};
      for (const double value : paper.percent) line.insert(line.end(), {"", "", published(value)});
      grid.rows.push_back(std::move(line));
    }
  return grid;
}

Grid paper_grid(std::span<const TransparencyRow> rows) {
  Grid grid{
      "### Paper 4's other tables\n\nExact over our own unsorted blending beside its SW/HW; "
      "samples a block (fragments over pieces in blocks of 8 × 8, as many as two of its "
      "half-blocks); the speed-up by finishing blocks at an alpha of 1 − 1/128.",
      {"scene, size", "exact ÷ unsorted", "filter:3 ÷ unsorted", "samples a block"},
      {}};
  for (const float opacity : kThresholdOpacities)
    grid.columns.push_back("threshold at opacity " + significant(static_cast<double>(opacity), 1));
  for (const TransparencyRow& row : rows) {
    const Lap& unsorted = row.ours[kUnsorted];
    std::vector<std::string> cells{title(row), times(row.ours[kExact], unsorted),
                                   times(row.ours[kFilter3], unsorted),
                                   significant(row.samples_per_block)};
    for (std::size_t i = 0; i + 1 < row.thresholds.size(); i += 2) {
      const Lap &without = row.thresholds[i], &with = row.thresholds[i + 1];
      cells.push_back(!without.ran() ? not_run(without)
                      : !with.ran()  ? not_run(with)
                                     : times(without, with));
    }
    grid.rows.push_back(std::move(cells));
  }
  const auto& paper = paper4::kOverUnsorted;
  grid.rows.push_back({"paper 4, average of its scenes and GPUs", "",
                       shortest(paper.average) + " (" + shortest(paper.least) + " to " +
                           shortest(paper.most) + ")"});
  return grid;
}

Plot plot_of(std::span<const TransparencyRow> rows) {
  Plot plot;
  plot.title = "A frame of translucent surfaces";
  plot.note = "full: Rastrum; pale: peers (a peer that ran out of patience is a lower bound)";
  plot.kind = Plot::Kind::bars;
  plot.x_title = "scene, size";
  plot.y_title = "ms";
  for (const TransparencyRow& row : rows) plot.places.push_back(title(row));
  Panel& panel = plot.panels.emplace_back();
  const auto add = [&](std::string name, int color, bool ghost, auto&& lap_of) {
    Series s{std::move(name), {}, color, ghost};
    for (const TransparencyRow& row : rows) {
      const Lap& lap = lap_of(row);
      s.values.push_back(lap.ran() ? lap.timing.median_ms() : kGap);
    }
    panel.series.push_back(std::move(s));
  };
  for (const std::size_t technique : {kUnsorted, kExact})
    add(std::string(kTechniques[technique].name), static_cast<int>(technique), false,
        [&](const TransparencyRow& row) -> const Lap& { return row.ours[technique]; });
  for (std::size_t peer = 0; peer < kPeerCount; ++peer)
    add(std::string(kPeerNames[peer]), static_cast<int>(peer) + 2, true,
        [&](const TransparencyRow& row) -> const Lap& { return row.peers[peer]; });
  return plot;
}

nlohmann::json json_of(const Lap& lap, bool ours) {
  if (!lap.ran()) return {{"name", lap.name}, {"not_run", lap.not_run}};
  nlohmann::json j = to_json(lap.timing);
  j["name"] = lap.name;
  j["share_right"] = lap.error.share();
  j["rmse"] = lap.error.rmse;
  j["worst"] = lap.error.worst;
  if (!ours) {
    j["passes"] = lap.passes;
    j["at_least"] = lap.at_least;
    return j;
  }
  j["peak_bytes"] = lap.stats.peak_bytes;
  j["wrong_pixels"] = lap.wrong_pixels;
  for (const auto& [counter, value] : lap.stats.counters) j["counters"][counter] = value;
  j["stages_ms"] = stages_ms(lap.stats);
  return j;
}

Grid device_grid(std::span<const TransparencyRow> rows) {
  Grid grid{
      "### On the device\n\nms a frame; arrays over, blended, the picture back. The floor: "
      "positions, normals and indices read once and pixels written once, at the device's "
      "bandwidth. Paper 4 has exact ÷ unsorted hardware blending " +
          shortest(paper4::kOverUnsorted.average) + " (" + shortest(paper4::kOverUnsorted.least) +
          " to " + shortest(paper4::kOverUnsorted.most) + ").",
      {"scene, size", "fragments", "unsorted", "exact", "exact ÷ unsorted", "threads' exact ÷ it",
       "10⁶ triangles/s", "10⁶ fragments/s", "floor", "exact ÷ floor"},
      {}};
  for (const TransparencyRow& row : rows) {
    const Lap &exact = row.device[0], &unsorted = row.device[1];
    std::vector<std::string>& cells = grid.rows.emplace_back(
        std::initializer_list<std::string>{title(row), std::to_string(row.work.fragments),
                                           ms(unsorted), ms(exact), times(exact, unsorted)});
    if (!exact.ran()) continue;
    const double frame_ms = exact.timing.median_ms();
    const auto rate = [&](std::uint64_t n) {
      return significant(static_cast<double>(n) / frame_ms / 1e3);
    };
    cells.insert(cells.end(), {times(row.ours[kExact], exact), rate(row.work.triangles),
                               rate(row.work.fragments), significant(row.device_floor_ms),
                               significant(frame_ms / row.device_floor_ms)});
  }
  return grid;
}

nlohmann::json json_of(const TransparencyRow& row) {
  nlohmann::json j = {{"scene", row.scene},
                      {"size", size_text(row.size)},
                      {"vertices", row.work.vertices},
                      {"triangles", row.work.triangles},
                      {"fragments", row.work.fragments},
                      {"deepest", row.deepest},
                      {"samples_per_block", row.samples_per_block},
                      {"list_bytes", row.list_bytes()},
                      {"opaque_bytes", row.opaque_bytes},
                      {"floor",
                       {{"bytes_ms", row.floor.bytes_ms},
                        {"operations_ms", row.floor.operations_ms},
                        {"binds", row.floor.binds()}}},
                      {"exact_over_unsorted", ratio(row.ours[kExact], row.ours[kUnsorted])},
                      {"goals_missed", missed_goals(row)}};
  for (const Lap& lap : row.ours) j["ours"].push_back(json_of(lap, true));
  for (const Lap& lap : row.peers) j["peers"].push_back(json_of(lap, false));
  for (const Lap& lap : row.device) j["device"].push_back(json_of(lap, true));
  if (!row.device.empty()) j["device_floor_ms"] = row.device_floor_ms;
  for (const Lap& lap : row.thresholds) j["thresholds"].push_back(json_of(lap, true));
  for (const Goal& goal : kGoals)
    j["ratios"][goal.name] = ratio(row.peers[goal.peer], row.ours[goal.technique]);
  return j;
}

}  // namespace

std::string missed_goals(const TransparencyRow& row) {
  std::string missed;
  const auto miss = [&](const std::string& what) {
    missed.append(missed.empty() ? "" : "; ").append(what);
  };
  const double over = ratio(row.ours[kExact], row.ours[kUnsorted]);
  if (over > kOverUnsortedWorst)
    miss("exact ÷ unsorted " + significant(over) + " > " + shortest(kOverUnsortedWorst));
  if (row.work.triangles < kGoalTriangles) return missed;
  for (const Goal& goal : kGoals) {
    const Lap& peer = row.peers[goal.peer];
    const double is = ratio(peer, row.ours[goal.technique]);
    if (is == 0 || is >= goal.times) continue;
    miss(std::string(goal.name) + (peer.at_least ? " > " : " ") + significant(is) +
         (peer.at_least ? ", not known whether " : " < ") + shortest(goal.times));
  }
  return missed;
}

void add_transparency(Document& document, std::span<const TransparencyRow> rows,
                      std::span<const std::string> absent) {
  for (const auto grid :
       {times_grid, peers_grid, memory_grid, techniques_grid, errors_grid, paper_grid}) {
    document.grids.push_back(grid(rows));
    add_absent(document.grids.back(), absent);
  }
  if (!rows.empty() && !rows.front().device.empty()) document.grids.push_back(device_grid(rows));
  for (const TransparencyRow& row : rows) document.figures.push_back(json_of(row));
  document.plot = plot_of(rows);
}

}  // namespace rastrum::bench
