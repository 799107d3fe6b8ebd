#include "render_ranks.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <rastrum/effects.hpp>
#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "annotations.hpp"
#include "input_spec.hpp"
#include "inputs.hpp"
#include "progress.hpp"
#include "render_outputs.hpp"
#include "timeline.hpp"
#include "view.hpp"

namespace rastrum::cli {
namespace {

/// What a shape counts as among files, where inputs are dealt by their bytes.
constexpr std::uint64_t kBuiltinBytes = 1 << 20;

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
  refuse(static_cast<bool>(a.stats), "--stats", "each of which has statistics of its own");
  refuse(a.view.file_camera.has_value(), "--camera", "each of which sees its own files' cameras");
  refuse(a.lights.of_files, "--lights file", "each of which sees its own files' lights");
  refuse(a.render.shadows, "--shadows", "each of which knows what stands in its own light");
  refuse(a.render.environment_behind, "--environment-behind", "which blend surfaces alone");
  refuse(a.render.rasterizer != "auto", "--rasterizer", "which draw with 'auto'");
  refuse(a.render.visibility != "auto", "--visibility", "which draw with 'auto'");
  const AnnotationOptions& notes = a.annotations;
  refuse(!notes.scalars.name.empty(), "--scalars", "since numbers have a range of all inputs");
  refuse(notes.bounds, "--bounds", "each of which knows the box of its own inputs");
  refuse(notes.edges, "--edges", "each of which knows the edges of its own inputs");
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
    load();
    binding_.emplace(inputs_.scene);
    a_.render.shader = shader_of(a_.render.shader, inputs_.has_materials);
    FitOfRanks fit(ranks_);
    const Camera camera = choose_camera(a_.view, inputs_.scene, binding_->view(),
                                        {a_.render.width, a_.render.height}, &fit);
    draw(camera, fit);
    return 0;
  }

 private:
  void load() {
    const std::vector<std::uint64_t> firsts = deal(ranks_, a_.inputs);
    const auto me = static_cast<std::size_t>(ranks_.rank());
    const std::vector<std::string> own(
        a_.inputs.begin() + static_cast<std::ptrdiff_t>(firsts[me]),
        a_.inputs.begin() + static_cast<std::ptrdiff_t>(firsts[me + 1]));
    do_alike(ranks_, "load inputs", [&] {
      if (own.empty()) return;
      inputs_ = load_inputs(own, a_.normals, timeline_, progress_, a_.format);
      set_sizes(inputs_.scene, a_.sizes);
      if (!a_.quiet) progress_.clear();
      for (const std::string& w : inputs_.scene.warnings) warn(w);
    });
    agree_on_scene(firsts);
  }

  /// What Scene::append sees to, and `auto` takes, where all inputs are one scene's.
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
          first_id += of_rank[i];
        }
      }
    });
  }

  void draw(const Camera& camera, FitRanks& fit) {
    Annotations notes = meant(a_.annotations);
    if (notes.occlusion && notes.occlusion->radius == 0)
      notes.occlusion->radius = 0.15 * bounding_sphere(binding_->view(), &fit).radius;
    std::optional<Annotator> annotator;
    Pictures pictures;
    Targets targets;
    do_alike(ranks_, "make images", [&] {
      if (!is_root_) return;
      progress_.show("rendering");
      annotator.emplace(a_.render.threads, a_.render.isa);
      targets = make_targets(wanted_of(a_, &notes, &*annotator), a_.render, pictures);
    });
    const double begin = timeline_.now_ms();
    const RanksStats stats =
        render_parts(ranks_, *renderer_, binding_->view(), parts_, camera, a_.render, targets);
    const double ms = timeline_.now_ms() - begin;
    draw_solid(camera, notes, pictures);
    do_alike(ranks_, "write files", [&] {
      if (!is_root_) return;
      progress_.clear();
      annotate_pictures(a_, notes, pictures, binding_->view(), camera, *annotator);
      OutputFiles files;
      write_images(a_, pictures, camera, all_, {}, files, timeline_, progress_);
      progress_.clear();
      files.commit();
      if (!a_.quiet && a_.color)
        std::fprintf(stderr, "%s: %dx%d, %llu triangles, %.1f ms on %d ranks\n",
                     a_.color.name().c_str(), a_.render.width, a_.render.height,
                     static_cast<unsigned long long>(stats.primitives), ms, ranks_.size());
    });
  }

  /// As Annotator::add_surface: what effects look at where textures blend.
  void draw_solid(const Camera& camera, const Annotations& notes, Pictures& pictures) {
    if (a_.render.transparency.method == Transparency::none ||
        !(notes.occlusion || notes.dome || notes.silhouettes))
      return;
    SceneView solid = binding_->view();
    std::vector<Material> materials;
    do_alike(ranks_, "look for blending textures", [&] {
      materials = materials_of_surface(solid);
      if (!materials.empty()) solid.materials = materials;
    });
    if (ranks_.max(materials.empty() ? 0 : 1) == 0) return;
    Targets targets;
    do_alike(ranks_, "make images of solids", [&] {
      if (!is_root_) return;
      const int width = a_.render.width, height = a_.render.height;
      targets.view_depth = solid_depth_ = Image<float>(width, height);
      if (!notes.silhouettes) return;
      targets.camera_normals = solid_normals_ = Image<Vec3>(width, height);
      targets.instances = solid_instances_ = Image<std::int64_t>(width, height);
    });
    (void)render_parts(ranks_, *renderer_, solid, parts_, camera, a_.render, targets);
    if (!is_root_) return;
    pictures.targets.view_depth = targets.view_depth;
    if (!notes.silhouettes) return;
    pictures.targets.camera_normals = targets.camera_normals;
    pictures.targets.instances = targets.instances;
  }

  RenderArguments& a_;
  Communicator& ranks_;
  bool is_root_;
  Timeline timeline_;
  Progress progress_;
  std::optional<Renderer> renderer_;
  Inputs inputs_;  ///< of this rank
  Inputs all_;     ///< of all: the parts alone
  std::optional<SceneBinding> binding_;
  std::vector<std::uint64_t> parts_;
  Image<float> solid_depth_;
  Image<Vec3> solid_normals_;
  Image<std::int64_t> solid_instances_;
};

}  // namespace

int render_with_ranks(RenderArguments& a, RanksOfProgram& program,
                      const std::function<void()>& check_files) {
  try {
    return RanksRun(a, program.ranks()).run(program, check_files);
  } catch (const UsageError& e) {
    // Of what all were given: they all know. Said before MPI ends, since a launcher may kill who is
    // slower to end than another that has failed.
    if (program.ranks().rank() == 0)
      std::fprintf(stderr, "rastrum: error: %s\nSee rastrum render --help.\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    // What all have agreed on is said once.
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
