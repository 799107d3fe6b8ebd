#include "render_ranks.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/annotate.hpp>
#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "annotations.hpp"
#include "camera_path.hpp"
#include "input_spec.hpp"
#include "inputs.hpp"
#include "json_file.hpp"
#include "light_options.hpp"
#include "picture_files.hpp"
#include "progress.hpp"
#include "render_outputs.hpp"
#include "stats_json.hpp"
#include "timeline.hpp"
#include "view.hpp"

namespace rastrum::cli {
namespace {

/// The size that a shape counts as among files, where inputs are dealt by their bytes.
constexpr std::uint64_t kBuiltinBytes = 1 << 20;
/// Bytes of the picture that a rank may hold, where no memory limit is given.
constexpr std::uint64_t kUsualBytes = std::uint64_t{1} << 30;

/// The most memory that this process has had, as the system counts it.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

/// The options that are of a whole scene, or of one renderer.
void check_for_ranks(const RenderArguments& a) {
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given)
      throw Error(Errc::unsupported,
                  std::string(option).append(": not with several ranks, ").append(why));
  };
  refuse(!a.path.empty(), "--path", "which draw one picture");
  refuse(a.turntable != 0, "--turntable", "which draw one picture");
  refuse(a.time_s.has_value(), "--time", "whose inputs do not move");
  refuse(a.frames_given, "--frames", "which draw one picture");
  refuse(static_cast<bool>(a.heatmap), "--heatmap", "since each counts its own fragments");
  refuse(static_cast<bool>(a.errors), "--show-errors", "which blend exactly");
  refuse(static_cast<bool>(a.trace), "--trace", "each of which has times of its own");
  refuse(a.render.environment_behind, "--environment-behind", "which blend surfaces alone");
  refuse(a.render.rasterizer != "auto", "--rasterizer", "which draw with 'auto'");
  refuse(a.render.visibility != "auto", "--visibility", "which draw with 'auto'");
  for (const std::string& input : a.inputs)
    refuse(parse_input(input).source == "-", "INPUT -", "of which one could read standard input");
}

std::uint64_t bytes_of(const std::string& input) {
  const std::string source = parse_input(input).source;
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(source, ignored);
  return ignored ? kBuiltinBytes : bytes;
}

/// Where each rank's inputs begin, and behind the last: runs of about equally many bytes, so that
/// the order of ranks is that of the command line. As the root's directory has them.
std::vector<std::uint64_t> deal(Communicator& ranks, const std::vector<std::string>& inputs) {
  const auto n = static_cast<std::size_t>(ranks.size());
  std::vector<std::uint64_t> firsts;
  do_alike(ranks, "deal inputs", [&] {
    firsts.resize(n + 1, inputs.size());
    if (ranks.rank() != 0) return;
    std::vector<double> begin{0};
    for (const std::string& input : inputs)
      begin.push_back(begin.back() + static_cast<double>(bytes_of(input)) + 1);
    std::size_t next = 0;
    for (std::size_t r = 0; r < n; ++r) {
      // An input goes to the rank in whose share its middle lies.
      const double share = begin.back() * static_cast<double>(r) / static_cast<double>(n);
      while (next < inputs.size() && (begin[next] + begin[next + 1]) / 2 < share) ++next;
      firsts[r] = next;
    }
    firsts[0] = 0;
  });
  ranks.broadcast(std::as_writable_bytes(std::span(firsts)), 0);
  return firsts;
}

/// One number of each rank.
std::vector<std::uint64_t> gather(Communicator& ranks, std::uint64_t number) {
  std::vector<std::uint64_t> all;
  for (const auto& bytes : gather_to_all(ranks, std::as_bytes(std::span(&number, 1))))
    std::memcpy(&all.emplace_back(), bytes.data(), sizeof(number));
  return all;
}

class RanksRun {
 public:
  RanksRun(RenderArguments& a, Communicator& ranks)
      : a_(a), ranks_(ranks), is_root_(ranks.rank() == 0), progress_(a.quiet || !is_root_) {
    a.quiet |= !is_root_;
  }

  int run(RanksOfProgram& program, const std::function<void()>& check_files) {
    do_alike(ranks_, "check options", [&] {
      check_for_ranks(a_);
      rastrum::check(a_.render);
      if (is_root_) check_files();
      // Ranks of one machine share its cores.
      if (a_.render.threads == 0)
        a_.render.threads = std::max(
            1, static_cast<int>(std::thread::hardware_concurrency()) / program.neighbours());
      renderer_.emplace(static_cast<const RendererOptions&>(a_.render));
    });
    const double begin = timeline_.now_ms();
    load();
    numbers_.load_ms = timeline_.now_ms() - begin;
    show_numbers();
    light_by_files();
    do_alike(ranks_, "bind", [&] { binding_.emplace(inputs_.scene); });
    a_.render.shader = shader_of(a_.render.shader, inputs_.has_materials);
    draw(camera());
    return 0;
  }

 private:
  void load() {
    const std::vector<std::uint64_t> firsts = deal(ranks_, a_.inputs);
    const auto me = static_cast<std::size_t>(ranks_.rank());
    const std::vector<std::string> names(
        a_.inputs.begin() + static_cast<std::ptrdiff_t>(firsts[me]),
        a_.inputs.begin() + static_cast<std::ptrdiff_t>(firsts[me + 1]));
    do_alike(ranks_, "load inputs", [&] {
      if (names.empty()) return;
      inputs_ = load_inputs(names, a_.normals, timeline_, progress_, a_.reading);
      for (const Output* const output : picture_outputs(a_)) check_is_not_read(*output);
      check_is_not_read(a_.stats);
      set_sizes(inputs_.scene, a_.sizes);
      if (!a_.quiet) progress_.clear();
      for (const std::string& w : inputs_.scene.warnings) warn(w);
    });
    agree_on_scene(firsts);
  }

  /// Makes the ranks' scenes agree as one scene of all inputs would: Scene::append adds plain
  /// materials, and `auto` looks at materials of all inputs.
  void agree_on_scene(const std::vector<std::uint64_t>& firsts) {
    const bool any_materials = ranks_.max(inputs_.scene.materials.empty() ? 0 : 1) != 0;
    inputs_.has_materials = ranks_.max(inputs_.has_materials ? 1 : 0) != 0;
    do_alike(ranks_, "join scenes", [&] {
      if (any_materials && inputs_.scene.materials.empty() && !inputs_.scene.instances.empty())
        add_plain_materials(inputs_.scene);
    });
    const std::vector<std::uint64_t> instances = gather(ranks_, inputs_.scene.instances.size());
    std::vector<std::uint64_t> primitives;
    for (const InputPart& part : inputs_.parts) primitives.push_back(part.triangles);
    const auto all = gather_to_all(ranks_, std::as_bytes(std::span(primitives)));
    do_alike(ranks_, "number parts", [&] {
      std::uint64_t first = 0;
      for (int r = 0; r < ranks_.rank(); ++r) first += instances[static_cast<std::size_t>(r)];
      for (std::size_t i = 0; i < inputs_.scene.instances.size(); ++i) parts_.push_back(first + i);
      std::uint64_t first_id = 0;
      for (std::size_t r = 0; r < all.size(); ++r) {
        std::vector<std::uint64_t> of_rank(firsts[r + 1] - firsts[r]);
        std::memcpy(of_rank.data(), all[r].data(), all[r].size());
        for (std::size_t i = 0; i < of_rank.size(); ++i) {
          all_.parts.push_back({a_.inputs[firsts[r] + i], first_id, of_rank[i]});
          rank_of_input_.push_back(r);
          first_id += of_rank[i];
        }
      }
    });
  }

  /// Does what set_scalars() does with one scene.
  void show_numbers() {
    const ScalarOptions& s = a_.annotations.scalars;
    if (s.name.empty()) return;
    Scene& scene = inputs_.scene;
    const bool known = ranks_.max(has_scalars(scene, s.name) ? 1 : 0) != 0;
    std::optional<SceneBinding> binding;
    do_alike(ranks_, "bind", [&] { binding.emplace(scene); });
    Bounds box;
    if (!known && s.name == "distance") box = bounds_of_ranks(ranks_, binding->view());
    do_alike(ranks_, "show numbers", [&] {
      if (known)
        scene.shown_scalars = s.name;
      else
        show_scalars(scene, s.name, &box);
      scene.scalar_mappings = {s.mapping};
      binding.emplace(scene);
    });
    if (s.isoline_count == 0) return;
    const std::vector<ScalarMapping> mappings = mappings_of_ranks(ranks_, binding->view());
    do_alike(ranks_, "add isolines",
             [&] { add_isolines(s, ScalarColors(mappings[0], {}).range(), scene); });
  }

  void light_by_files() {
    if (!a_.lights.of_files) return;
    Scene lights;
    lights.lights = lights_of_ranks(ranks_, inputs_.scene.lights);
    do_alike(ranks_, "add lights", [&] { add_file_lights(lights, a_.render.lights); });
  }

  [[nodiscard]] Camera camera() {
    if (a_.view.file_camera)
      inputs_.scene.cameras = cameras_of_ranks(ranks_, inputs_.scene.cameras);
    FitOfRanks fit(ranks_);
    const Size size{a_.render.width, a_.render.height};
    const Camera chosen = choose_camera(a_.view, inputs_.scene, binding_->view(), size, &fit);
    if (a_.view.file_camera || a_.view.eye || a_.view.orthographic_height) return chosen;
    const Annotations notes = meant(a_.annotations);
    Bounds box;
    if (notes.bounds) box = bounds_of_ranks(ranks_, binding_->view());
    return with_room(notes, chosen, box, size.width, size.height);
  }

  void draw(const Camera& camera) {
    const Annotations notes = meant(a_.annotations);
    if (const int rows = rows_of(notes); rows != 0) return draw_in_bands(camera, rows);
    std::optional<Annotator> annotator;
    Pictures pictures;
    Targets targets;
    do_alike(ranks_, "make images", [&] {
      annotator.emplace(a_.render.threads, a_.render.isa);
      if (!is_root_) return;
      progress_.show("rendering");
      targets = make_targets(wanted_of(a_), a_.render, pictures);
    });
    const double begin = timeline_.now_ms();
    const RanksStats stats = notes.any()
                                 ? render_parts(ranks_, *renderer_, *annotator, binding_->view(),
                                                parts_, camera, a_.render, notes, targets)
                                 : render_parts(ranks_, *renderer_, binding_->view(), parts_,
                                                camera, a_.render, targets);
    const double ms = timeline_.now_ms() - begin;
    nlohmann::ordered_json numbers;
    if (a_.stats) numbers = statistics(stats, ms, camera);
    do_alike(ranks_, "write files", [&] {
      if (!is_root_) return;
      progress_.clear();
      OutputFiles files;
      write_images(a_, pictures, camera, all_, {}, files, timeline_, progress_);
      progress_.clear();
      if (a_.stats) write_json(files.begin(a_.stats), numbers);
      files.commit();
      say_done(stats, ms);
    });
  }

  /// How many rows of the picture are drawn at once; 0: all, where that fits or where something is
  /// of the whole picture.
  [[nodiscard]] int rows_of(const Annotations& notes) const {
    const std::uint64_t limit = a_.render.memory_limit;
    const std::uint64_t bytes = limit == 0 ? kUsualBytes : limit / 4;
    const int rows = rows_at_once(a_, bytes);
    if (rows == 0) return 0;
    const char* const why = why_whole(a_, notes);
    if (why == nullptr) return rows;
    if (!a_.quiet)
      warn(std::string(why)
               .append(" a whole picture, so the first rank holds it; ranks draw it in bands of ")
               .append(std::to_string(rows))
               .append(" rows without (--look plain)"));
    return 0;
  }

  /// The picture is drawn and written from the top, some rows at once: no rank holds all of it.
  void draw_in_bands(const Camera& camera, int rows) {
    Pictures band;
    Targets targets;
    OutputFiles files;
    std::optional<PictureFiles> pictures;
    do_alike(ranks_, "begin files", [&] {
      if (!is_root_) return;
      FrameOptions held = a_.render;
      held.height = rows;
      targets = make_targets(wanted_of(a_), held, band);
      pictures.emplace(a_, camera, all_, files);
    });
    RanksOptions options;
    options.rows = rows;
    options.take_rows = [&](int first, int last) {
      progress_.show("rows " + std::to_string(last) + " of " + std::to_string(a_.render.height));
      pictures->add(band, last - first);
    };
    const double begin = timeline_.now_ms();
    const RanksStats stats = render_parts(ranks_, *renderer_, binding_->view(), parts_, camera,
                                          a_.render, targets, options);
    const double ms = timeline_.now_ms() - begin;
    nlohmann::ordered_json numbers;
    if (a_.stats) {
      numbers = statistics(stats, ms, camera);
      numbers["rows_at_once"] = rows;
    }
    do_alike(ranks_, "write files", [&] {
      if (!is_root_) return;
      pictures->finish();
      progress_.clear();
      if (a_.stats) write_json(files.begin(a_.stats), numbers);
      files.commit();
      say_done(stats, ms);
    });
  }

  void say_done(const RanksStats& stats, double ms) const {
    if (!a_.quiet && a_.color)
      std::fprintf(stderr, "%s: %dx%d, %llu triangles, %.1f ms on %d ranks\n",
                   a_.color.name().c_str(), a_.render.width, a_.render.height,
                   static_cast<unsigned long long>(stats.primitives), ms, ranks_.size());
  }

  [[nodiscard]] nlohmann::ordered_json statistics(const RanksStats& stats, double ms,
                                                  const Camera& camera) {
    numbers_.frame_ms = ms;
    numbers_.primitives = static_cast<double>(inputs_.scene.primitive_count());
    numbers_.words = static_cast<double>(stats.words);
    numbers_.won = static_cast<double>(stats.won);
    numbers_.fragments = static_cast<double>(stats.fragments);
    numbers_.peak_bytes = peak_bytes();
    const auto bytes = gather_to_all(ranks_, std::as_bytes(std::span(&numbers_, 1)));
    nlohmann::ordered_json json;
    do_alike(ranks_, "add statistics", [&] {
      std::vector<RankNumbers> all(bytes.size());
      for (std::size_t r = 0; r < all.size(); ++r)
        std::memcpy(&all[r], bytes[r].data(), sizeof(RankNumbers));
      json = stats_json(all, stats, a_.render);
      nlohmann::ordered_json& parts = json["inputs"] = nlohmann::ordered_json::array();
      for (std::size_t i = 0; i < all_.parts.size(); ++i)
        parts.push_back({{"name", all_.parts[i].name},
                         {"first_id", all_.parts[i].first_id},
                         {"triangles", all_.parts[i].triangles},
                         {"rank", rank_of_input_[i]}});
      json["cameras"] = {camera_json(camera, true)};
    });
    return json;
  }

  RenderArguments& a_;
  Communicator& ranks_;
  bool is_root_;
  Timeline timeline_;
  Progress progress_;
  std::optional<Renderer> renderer_;
  Inputs inputs_;  ///< of this rank
  Inputs all_;     ///< of all: the parts alone
  std::vector<std::size_t> rank_of_input_;
  RankNumbers numbers_;
  std::optional<SceneBinding> binding_;
  std::vector<std::uint64_t> parts_;
};

}  // namespace

int render_with_ranks(RenderArguments& a, RanksOfProgram& program,
                      const std::function<void()>& check_files) {
  try {
    return RanksRun(a, program.ranks()).run(program, check_files);
  } catch (const UsageError& e) {
    // All ranks were given the same wrong arguments and know it, so only one reports it. It does so
    // before MPI ends, since a launcher may kill a rank that is slower to end than another that has
    // failed.
    if (program.ranks().rank() == 0)
      std::fprintf(stderr, "rastrum: error: %s\nSee rastrum render --help.\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    // An error that all ranks have agreed on is reported once.
    const bool agreed = std::string_view(e.what()).starts_with("rank ");
    if (!agreed)
      std::fprintf(stderr, "rastrum: error: rank %d: %s\n", program.ranks().rank(), e.what());
    else if (program.ranks().rank() == 0)
      std::fprintf(stderr, "rastrum: error: %s\n", e.what());
    if (!agreed) program.give_up();
    return 1;
  }
}

}  // namespace rastrum::cli
