// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench stages`: the cost of a submitted triangle and of a pixel in each stage of an
// opaque frame on one thread, beside the project's budgets; whole frames by instruction set; and
// every built-in shader over `flat`. Every picture is first compared with plain C++'s, bit by bit.
//
// The frame's own times give the stages project, setup and binning. Frames that differ only in the
// shader give the others, by differences round by round. Cycles are ns times the clock rate, which
// a chain of dependent additions shows in the same rounds: hosted machines often hide their
// counters.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/render.hpp>

#include "measure.hpp"
#include "peers/selection.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "scenes.hpp"
#include "stand_ins.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

/// The project's budgets in cycles.
constexpr double kSetupBudget = 45, kCoverBudget = 75, kAttributesBudget = 12, kLightBudget = 2;
/// A shader may take this many times as long as `flat` plus its own light.
constexpr double kShaderBudget = 1.3;

constexpr std::uint64_t kAdditions = 1 << 21;

/// kAdditions dependent additions, one cycle each on every processor. The addend is in a register,
/// since some processors add constants at no cost.
std::uint64_t chain_of_additions() {
  std::uint64_t sum = 0, addend = 3;
  for (std::uint64_t i = 0; i < kAdditions; i += 16)
    for (int k = 0; k < 16; ++k) {
      asm volatile("" : "+r"(sum), "+r"(addend));
      sum += addend;
    }
  return sum;
}

struct ShaderEntry {
  Shader shader;
  Isa isa;
  std::unique_ptr<Renderer> renderer;
  FrameStats stats = {};
  std::map<std::string, std::vector<double>> stages_ms = {};

  [[nodiscard]] std::string name() const {
    return std::string(rastrum::name(shader)).append(", ").append(rastrum::name(isa));
  }
  /// The median of the stages whose names begin so; 0 if there are none.
  [[nodiscard]] double stage_ms(std::string_view begin) const {
    double sum = 0;
    for (const auto& [stage, ms] : stages_ms)
      if (stage.starts_with(begin)) sum += median(ms);
    return sum;
  }
};

/// The median over rounds of how much longer `more` takes than `less`, ms.
double difference_ms(const Timing& more, const Timing& less) {
  std::vector<double> all;
  for (std::size_t i = 0; i < more.samples_ms.size(); ++i)
    all.push_back(more.samples_ms[i] - less.samples_ms[i]);
  return median(std::move(all));
}

struct Tables {
  Grid stages{
      "", {"scene, stage", "counted", "ms", "ns each", "cycles each", "budget", "÷ budget"}, {}};
  Grid isas;  ///< columns depend on this machine
  Grid shaders{"", {"scene, shader", "ms", "÷ flat", "cycles a covered pixel over flat"}, {}};
  Panel panel{"shader over flat", {}};
  std::vector<std::string> places;
  nlohmann::json figures = nlohmann::json::array();
};

class Contest {
 public:
  Contest(const TableOptions& options, Size size) : options_(options), isas_(available_isas()) {
    frame_.width = size.width;
    frame_.height = size.height;
    std::erase(isas_, Isa::scalar);
    for (const std::string_view name : shader_names())
      if (const Shader shader = shader_from_name(name); shader != Shader::automatic)
        add(shader, isas_.empty() ? Isa::scalar : isas_.back());
    for (std::size_t i = 0; i + 1 < isas_.size(); ++i)
      for (const Shader shader : {Shader::flat, Shader::phong}) add(shader, isas_[i]);
  }

  [[nodiscard]] const std::vector<Isa>& isas() const { return isas_; }

  /// Returns whether all pictures equal plain C++'s.
  bool measure(const SceneInfo& info, Tables& tables) {
    const Mesh mesh = load(info);
    const MeshView view = mesh.view();
    const InstanceView instance{view};
    const SceneView scene{.instances = {&instance, 1}};
    const Camera camera = whole_view(mesh);
    Image<Rgba8> picture(frame_.width, frame_.height);
    const auto draw = [&](ShaderEntry& e) {
      FrameOptions frame = frame_;
      frame.shader = e.shader;
      e.stats = e.renderer->render(scene, camera, frame, {.color8 = picture});
      for (const auto& [stage, ms] : stages_ms(e.stats)) e.stages_ms[stage].push_back(ms);
    };
    if (!is_right(scene, camera, info, picture, draw)) return false;
    std::vector<Contender> contenders;
    for (ShaderEntry& e : entries_) {
      e.stages_ms.clear();
      contenders.push_back({e.name(), [&draw, &e] { draw(e); }});
    }
    contenders.push_back({"clock", [] { (void)chain_of_additions(); }});
    timings_ = measure_interleaved(contenders, options_.plan());
    write(info, tables);
    return true;
  }

 private:
  void add(Shader shader, Isa isa) {
    entries_.push_back(
        {shader, isa,
         std::make_unique<Renderer>(RendererOptions{.threads = options_.threads, .isa = isa})});
  }

  bool is_right(const SceneView& scene, const Camera& camera, const SceneInfo& info,
                Image<Rgba8>& picture, const std::function<void(ShaderEntry&)>& draw) {
    Renderer plain({.threads = options_.threads, .isa = Isa::scalar});
    Image<Rgba8> expected(frame_.width, frame_.height);
    for (ShaderEntry& e : entries_) {
      FrameOptions frame = frame_;
      frame.shader = e.shader;
      (void)plain.render(scene, camera, frame, {.color8 = expected});
      draw(e);
      if (same_bits(picture, expected)) continue;
      std::fprintf(stderr, "%s: the picture of %s is not plain C++'s\n",
                   std::string(info.name).c_str(), e.name().c_str());
      return false;
    }
    return true;
  }

  [[nodiscard]] std::size_t at(Shader shader, Isa isa) const {
    const auto found = std::ranges::find_if(
        entries_, [&](const ShaderEntry& e) { return e.shader == shader && e.isa == isa; });
    return static_cast<std::size_t>(found - entries_.begin());
  }

  void write(const SceneInfo& info, Tables& t) const {
    const Isa best = entries_.front().isa;
    const Timing& flat = timings_[at(Shader::flat, best)];
    const Timing& lambert = timings_[at(Shader::lambert, best)];
    const Timing& phong = timings_[at(Shader::phong, best)];
    const ShaderEntry& counted = entries_[at(Shader::flat, best)];
    const double ghz = static_cast<double>(kAdditions) / (timings_.back().median_ms() * 1e6);
    const auto triangles = static_cast<double>(counted.stats.triangles.input);
    const auto pixels = static_cast<double>(counted.stats.pixels_covered);
    const std::string scene(info.name);
    t.stages.rows.push_back({scene + ": " + std::to_string(counted.stats.triangles.input) +
                             " triangles, " + std::to_string(counted.stats.pixels_covered) +
                             " pixels covered, " + significant(ghz) + " GHz"});
    const auto stage = [&](const char* what, const char* of, double count, double ms,
                           double budget) {
      const double cycles = ms * 1e6 / count * ghz;
      t.stages.rows.push_back({what, of, significant(ms), significant(ms * 1e6 / count),
                               significant(cycles), budget > 0 ? significant(budget) : "",
                               budget > 0 ? significant(cycles / budget) : ""});
      t.figures.push_back({{"scene", scene},
                           {"stage", what},
                           {"ms", ms},
                           {"ns", ms * 1e6 / count},
                           {"cycles", cycles},
                           {"budget", budget},
                           {"ghz", ghz},
                           {"count", count}});
    };
    const double project = counted.stage_ms("project"), setup = counted.stage_ms("setup");
    stage("project", "triangle", triangles, project, 0);
    stage("setup and binning", "triangle", triangles, setup, kSetupBudget);
    stage("cover, maximum, store (flat)", "triangle", triangles, counted.stage_ms("draw"),
          kCoverBudget);
    stage("attributes (lambert − flat)", "pixel", pixels, difference_ms(lambert, flat),
          kAttributesBudget);
    stage("light (phong − lambert)", "pixel", pixels, difference_ms(phong, lambert), kLightBudget);
    write_isas(scene, t);
    t.places.push_back(scene);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const ShaderEntry& e = entries_[i];
      if (e.isa != best) continue;
      const double ratio = median_ratio(timings_[i], flat);
      const double over = difference_ms(timings_[i], flat) * 1e6 / pixels * ghz;
      const std::string shader(rastrum::name(e.shader));
      t.shaders.rows.push_back({scene + ", " + shader, significant(timings_[i].median_ms()),
                                significant(ratio), significant(over)});
      const auto series = std::ranges::find(t.panel.series, shader, &Series::name);
      if (series == t.panel.series.end())
        t.panel.series.push_back({shader, {ratio}, static_cast<int>(t.panel.series.size())});
      else
        series->values.push_back(ratio);
      t.figures.push_back({{"scene", scene},
                           {"shader", shader},
                           {"ratio", ratio},
                           {"cycles_over_flat", over},
                           {"timing", to_json(timings_[i])}});
    }
  }

  void write_isas(const std::string& scene, Tables& t) const {
    for (const Shader shader : {Shader::flat, Shader::phong}) {
      std::vector<std::string> row{scene, std::string(rastrum::name(shader))};
      for (std::size_t i = 0; i < isas_.size(); ++i) {
        const Timing& mine = timings_[at(shader, isas_[i])];
        row.push_back(significant(mine.median_ms()));
        t.figures.push_back({{"scene", scene},
                             {"isa", rastrum::name(isas_[i])},
                             {"shader", rastrum::name(shader)},
                             {"timing", to_json(mine)}});
      }
      for (std::size_t i = 1; i < isas_.size(); ++i)
        row.push_back(significant(
            median_ratio(timings_[at(shader, isas_[i - 1])], timings_[at(shader, isas_[i])])));
      t.isas.rows.push_back(std::move(row));
    }
  }

  const TableOptions& options_;
  FrameOptions frame_;
  std::vector<Isa> isas_;  ///< those with SIMD lanes, the best last
  std::vector<ShaderEntry> entries_;
  std::vector<Timing> timings_;  ///< of the entries, then of the clock
};

}  // namespace

int run_stages(std::span<const std::string_view> arguments) {
  TableOptions options;
  options.threads = 1;
  std::string json;
  Selection selection({scene_by_name("bunny"), scene_by_name("dragon"), scene_by_name("brain")},
                      {{1024, 1024}});
  OptionParser parser("stages", "Cycles a triangle and a pixel of each stage, on one thread.");
  parser.add_option("--rounds", options.rounds, "rounds of A B C … (default: 9)")->range(1, 1000);
  parser.add_option("--out", options.out, "write NAME.md, NAME.json and NAME.svg into FOLDER")
      ->type_name("FOLDER");
  parser.add_option("--json", json, "write the figures with all samples to FILE")
      ->type_name("FILE");
  parser.add_flag("--quick", options.quick,
                  "a smoke test: 1 round, pictures of an eighth of the edge");
  selection.add_to(parser);
  if (const auto status = parser.parse(arguments)) return *status;
  options.resolve();
  if (options.quick) {
    selection.set_sizes({{128, 128}});
    selection.set_scenes({procedural_scenes().front()});
  }
  selection.resolve();

  Tables tables;
  for (const Size size : selection.sizes())
    for (const SceneInfo& info : selection.scenes()) {
      progress(std::string(info.name) + " " + size_text(size));
      Contest contest(options, size);
      if (tables.isas.columns.empty()) {
        std::vector<std::string>& columns = tables.isas.columns;
        columns = {"scene", "shader"};
        const std::vector<Isa>& isas = contest.isas();
        for (const Isa isa : isas) columns.push_back(std::string(name(isa)) + " ms");
        for (std::size_t i = 1; i < isas.size(); ++i)
          columns.push_back(std::string(name(isas[i - 1])) + " ÷ " + std::string(name(isas[i])));
      }
      if (!contest.measure(info, tables)) return 1;
    }

  Document document = options.document("stages", "What each stage costs");
  document.notes.push_back(
      options.here() +
      "; every picture was plain C++'s, bit by bit. Cycles are ns × the clock that a chain of "
      "dependent additions showed in the same rounds; ratios and differences are medians of paired "
      "rounds. A shader's goal is " +
      significant(kShaderBudget) + " × `flat` and its own light.");
  document.grids = {std::move(tables.stages), std::move(tables.isas), std::move(tables.shaders)};
  document.figures = std::move(tables.figures);
  Plot plot;
  plot.title = "Shaders over flat";
  plot.note = options.here();
  plot.kind = Plot::Kind::bars;
  plot.log_y = false;
  plot.y_title = "ratio";
  plot.places = std::move(tables.places);
  plot.panels = {std::move(tables.panel)};
  document.plot = std::move(plot);
  publish(document, options.out);
  if (!json.empty()) write_json(json, to_json(document));
  return 0;
}

}  // namespace rastrum::bench
