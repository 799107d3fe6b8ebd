// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench replay`: replays frames recorded on one thread on 1 to 256 simulated workers and
// shows what limits each stage. Times of two real threads stand beside it.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <rastrum/prepared_mesh.hpp>
#include <rastrum/render.hpp>

#include <bench/measure.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/scenes.hpp>
#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>
#include <papers/models/replay/costs.hpp>
#include <papers/models/replay/simulate.hpp>

namespace rastrum::bench {
namespace {

constexpr std::array kWorkers{1, 2, 4, 8, 16, 32, 64, 128, 256};
/// The numbers of workers at which stages are examined. The project's goal is for a million
/// triangles at 1080p.
constexpr std::array kLooked{16, 64};

/// A stage of a frame on a number of workers, ns.
struct Stage {
  std::string name;
  double serial = 0;               ///< between loops, on the caller's thread
  double work = 0;                 ///< of all tasks
  double largest = 0, excess = 0;  ///< tasks; by how much a loop's largest exceeds its mean share
  double loops_ns = 0;             ///< as replayed
  std::size_t loops = 0, tasks = 0;

  [[nodiscard]] double ns() const { return serial + loops_ns; }
};

struct Replayed {
  double ns = 0;
  std::vector<Stage> stages;
  ReplayedFrame frame;
};

struct Drawn {
  std::string name;
  SceneView scene;
  Camera camera;
  FrameOptions frame;
};

/// One frame, recorded on one thread but split as for a number of workers.
struct Shot {
  RecordedFrame frame;
  std::vector<StageTime> stages;  ///< ms since the frame's begin
};

Shot shoot(Renderer& renderer, const Drawn& s, Image<Rgba8>& picture, int workers) {
  Shot shot;
  shot.frame.recording.workers = workers;
  const parallel::RecordScope scope(shot.frame.recording);
  shot.frame.begin_ns = parallel::Recording::now_ns();
  const FrameStats stats = renderer.render(s.scene, s.camera, s.frame, {.color8 = picture});
  shot.frame.end_ns = parallel::Recording::now_ns();
  const double all = static_cast<double>(shot.frame.end_ns - shot.frame.begin_ns) * 1e-6;
  const double before = std::max(0.0, all - stats.frame_ms);  // in the façade
  shot.stages.push_back({"prepare", 0, before});
  for (const StageTime& stage : stats.stages)
    shot.stages.push_back({stage.name, stage.begin_ms + before, stage.end_ms + before});
  shot.stages.back().end_ms = all;
  return shot;
}

std::size_t stage_at(const Shot& shot, double ms) {
  std::size_t k = 0;
  while (k + 1 < shot.stages.size() && ms > shot.stages[k].end_ms) ++k;
  return k;
}

/// Merges stages of the same name.
std::vector<Stage> stages_of(std::span<const Shot> shots, const ReplayedFrame& frame,
                             const Replay& replayed, int workers) {
  const Shot& last = shots.back();
  const auto loop_stage = [](const Shot& shot, std::size_t l) {
    const auto& loop = shot.frame.recording.loops[l];
    return stage_at(
        shot, static_cast<double>((loop.begin_ns + loop.end_ns) / 2 - shot.frame.begin_ns) * 1e-6);
  };
  std::vector<Stage> stages;
  for (std::size_t k = 0; k < last.stages.size(); ++k) {
    std::vector<double> serial;
    for (const Shot& shot : shots) {
      if (shot.stages.size() != last.stages.size() ||
          shot.frame.recording.loops.size() != last.frame.recording.loops.size())
        continue;
      double ns = (shot.stages[k].end_ms - shot.stages[k].begin_ms) * 1e6;
      for (std::size_t l = 0; l < shot.frame.recording.loops.size(); ++l)
        if (loop_stage(shot, l) == k)
          ns -= static_cast<double>(shot.frame.recording.loops[l].end_ns -
                                    shot.frame.recording.loops[l].begin_ns);
      serial.push_back(ns);
    }
    const std::string& name = last.stages[k].name;
    auto stage = std::ranges::find(stages, name, &Stage::name);
    if (stage == stages.end()) {
      stages.push_back({.name = name});
      stage = stages.end() - 1;
    }
    stage->serial += std::max(0.0, median(std::move(serial)));
    for (std::size_t l = 0; l < frame.loops.size(); ++l) {
      if (loop_stage(last, l) != k) continue;
      const ReplayedLoop& loop = frame.loops[l];
      const double work = loop.work(), largest = loop.largest();
      stage->work += work;
      stage->largest = std::max(stage->largest, largest);
      stage->excess += std::max(0.0, largest - work / workers);
      stage->loops_ns += replayed.loops[l];
      ++stage->loops;
      stage->tasks += loop.tasks();
    }
  }
  return stages;
}

/// Records the last `rounds` frames. The frames before allocate memory and find hints.
Replayed replayed(Renderer& renderer, const Drawn& s, Image<Rgba8>& picture, int workers,
                  int rounds, const LoopCosts& costs) {
  std::vector<Shot> shots;
  for (int i = 0; i < 3; ++i) (void)shoot(renderer, s, picture, workers);
  for (int i = 0; i < rounds; ++i) shots.push_back(shoot(renderer, s, picture, workers));
  std::vector<RecordedFrame> frames;
  for (const Shot& shot : shots) frames.push_back(shot.frame);
  const ReplayedFrame frame = median_frame(frames);
  const Replay result = replay(frame, workers, costs);
  return {result.ns, stages_of(shots, frame, result, workers), frame};
}

std::string whole_percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", 100 * share);
  return text;
}
/// The speed, and its share of the workers.
std::string speed_text(double speed, int workers) {
  return significant(speed) + " (" + whole_percent(speed / workers) + " %)";
}
std::string microseconds(double ns) {
  return significant(ns * 1e-3);
}

/// The main cause of a stage's loss.
std::string binds(const Stage& s, int workers) {
  const double ideal = s.work / workers;
  const double serial = s.serial, excess = s.excess, rest = s.loops_ns - ideal - s.excess;
  if (serial >= excess && serial >= rest) return "serial";
  if (excess >= rest) return "largest task";
  return s.tasks < 4 * static_cast<std::size_t>(workers) * s.loops ? "few tasks" : "hand-over";
}

class ReplayTable {
 public:
  ReplayTable(const TableOptions& options, const LoopCosts& costs, Document& document)
      : options_(options), costs_(costs), document_(document) {
    speed_.columns = {"what", "1 thread, ms", "2 replayed", "2 measured", "replayed ÷ measured"};
    for (std::size_t i = 1; i < kWorkers.size(); ++i)
      speed_.columns.push_back(std::to_string(kWorkers[i]));
    for (const int workers : kLooked)
      stages_.push_back({"Why a stage does not scale to " + std::to_string(workers) +
                             " workers, µs; lost: of the frame's time, beyond a share of the work",
                         {"what", "stage", "serial", "loops", "tasks", "work", "largest task",
                          "replayed", "lost, %", "by"},
                         {}});
  }

  /// Returns whether the pictures are equal.
  [[nodiscard]] bool add(const Drawn& s) {
    std::fprintf(stderr, "  %s\n", s.name.c_str());
    Image<Rgba8> a(s.frame.width, s.frame.height), b(s.frame.width, s.frame.height);
    Renderer one({.threads = 1}), two({.threads = 2});
    (void)two.render(s.scene, s.camera, s.frame, {.color8 = b});
    bool right = true;
    std::vector<Replayed> all;
    for (const int workers : kWorkers) {
      all.push_back(replayed(one, s, a, workers, options_.rounds, costs_));
      if (same_bits(a, b)) continue;
      std::fprintf(stderr, "%s: %d workers draw another picture\n", s.name.c_str(), workers);
      right = false;
    }
    const auto draw = [&](Renderer& renderer) {
      (void)renderer.render(s.scene, s.camera, s.frame, {.color8 = a});
    };
    const std::vector<Contender> contenders{{"1", [&] { draw(one); }}, {"2", [&] { draw(two); }}};
    const std::vector<Timing> timings = measure_interleaved(contenders, options_.plan());
    const double one_ms = timings[0].median_ms(), ratio = median_ratio(timings[0], timings[1]);
    const double base = all[0].ns;
    std::vector<std::string> row{s.name, significant(one_ms), significant(base / all[1].ns),
                                 significant(ratio), significant(base / all[1].ns / ratio)};
    for (std::size_t i = 1; i < kWorkers.size(); ++i) {
      const double speed = base / all[i].ns;
      row.push_back(speed_text(speed, kWorkers[i]));
      document_.figures.push_back({{"what", s.name},
                                   {"workers", kWorkers[i]},
                                   {"ms", all[i].ns * 1e-6},
                                   {"speed_up", speed},
                                   {"efficiency", speed / kWorkers[i]}});
    }
    speed_.rows.push_back(std::move(row));
    std::vector<std::string> uncut{s.name + ", cut as for one thread", "", "", "", ""};
    for (std::size_t i = 1; i < kWorkers.size(); ++i)
      uncut.push_back(speed_text(base / replay(all[0].frame, kWorkers[i], costs_).ns, kWorkers[i]));
    speed_.rows.push_back(std::move(uncut));
    Series series{s.name, {}, static_cast<int>(efficiency_.series.size())};
    for (std::size_t i = 0; i < kWorkers.size(); ++i)
      series.values.push_back(100 * base / all[i].ns / kWorkers[i]);
    efficiency_.series.push_back(std::move(series));
    for (std::size_t k = 0; k < kLooked.size(); ++k) {
      const auto at =
          static_cast<std::size_t>(std::ranges::find(kWorkers, kLooked[k]) - kWorkers.begin());
      for (const Stage& stage : all[at].stages) {
        const double lost = stage.ns() - (stage.work + stage.serial) / kLooked[k];
        stages_[k].rows.push_back(
            {s.name, stage.name, microseconds(stage.serial), std::to_string(stage.loops),
             std::to_string(stage.tasks), microseconds(stage.work), microseconds(stage.largest),
             microseconds(stage.ns()), whole_percent(lost / all[at].ns), binds(stage, kLooked[k])});
      }
    }
    return right;
  }

  void finish() {
    document_.grids.push_back(std::move(speed_));
    for (Grid& grid : stages_) document_.grids.push_back(std::move(grid));
    Plot plot;
    plot.title = document_.title;
    plot.note = "replayed, not measured";
    plot.x_title = "workers";
    plot.y_title = "efficiency, %";
    plot.log_y = false;
    for (const int workers : kWorkers) plot.places.push_back(std::to_string(workers));
    plot.panels.push_back(std::move(efficiency_));
    document_.plot = std::move(plot);
  }

 private:
  const TableOptions& options_;
  const LoopCosts& costs_;
  Document& document_;
  Grid speed_{"Speed-up (efficiency) on simulated workers", {}, {}};
  std::vector<Grid> stages_;
  Panel efficiency_{"frame", {}};
};

}  // namespace

int run_replay(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("replay", "A frame's tasks, recorded on one thread, on simulated workers.");
  if (const auto status = options.read(parser, arguments, true)) return *status;
  const LoopCosts costs = measure_costs(options.quick ? 5 : 50);
  Document document = options.document("replay", "Frames on more cores than there are");
  char text[400];
  std::snprintf(
      text, sizeof text,
      "The scheduler's own, measured here with two threads: a loop %.0f ns, a task %.0f, taken "
      "by another worker %.0f, seen to have ended %.0f, the next index %.0f; workers "
      "sleep after %.0f µs and wake in %.0f µs. Assumed: a look into an empty queue "
      "%.0f ns.",
      costs.loop, costs.task, costs.take, costs.join, costs.claim, costs.linger * 1e-3,
      costs.wake * 1e-3, costs.look);
  document.notes.emplace_back(text);
  document.notes.push_back(
      "`phong`, " + std::to_string(options.size(1920)) + " × " +
      std::to_string(options.size(1080)) + ", medians of " + std::to_string(options.rounds) +
      " frames recorded on one thread, which cuts its work as so many workers would; memory that "
      "they share is not simulated. All pictures are equal bits.");
  ReplayTable table(options, costs, document);
  bool right = true, any = false;
  const auto add = [&](const SceneInfo& info) {
    any = true;
    const Mesh mesh = load(info);
    const MeshView view = mesh.view();
    const PreparedMesh prepared(view, options.threads);
    const InstanceView plain_instance{view}, prepared_instance{prepared.view()};
    Drawn s{std::string(info.name), {.instances = {&plain_instance, 1}}, {}, {}};
    s.camera = fit_camera(s.scene, 1.0472F, false);
    s.frame.width = options.size(1920);
    s.frame.height = options.size(1080);
    s.frame.shader = Shader::phong;
    right = table.add(s) && right;
    s.frame.opacity = 0.3F;
    s.name = std::string(info.name) + ", opacity 0.3";
    right = table.add(s) && right;
    s.frame.opacity = 1;
    s.name = std::string(info.name) + ", prepared";
    s.scene = {.instances = {&prepared_instance, 1}};
    right = table.add(s) && right;
  };
  for (const SceneInfo& info : peer_scenes()) {
    const std::array<std::string_view, 4> shown{"bunny", "sponza", "dragon", "brain"};
    const bool asked = options.mesh.empty() ? std::ranges::count(shown, info.name) != 0
                                            : options.mesh == info.name;
    if (asked && available(info) && !options.quick) add(info);
  }
  if (!any)
    for (const SceneInfo& info : procedural_scenes())
      if (options.quick ? info.name == "torus-knot"
                        : options.mesh.empty() || options.mesh == info.name)
        add(info);
  if (!any) (void)scene_by_name(options.mesh);
  table.finish();
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
