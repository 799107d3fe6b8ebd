// SPDX-License-Identifier: BSD-3-Clause
#include "part_job.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <thread>

#include <rastrum/error.hpp>

#include "camera.hpp"

namespace rastrum::cli {
namespace {

/// The size of a shape among files when inputs are dealt by their bytes.
constexpr std::uint64_t kBuiltinBytes = 1 << 20;

/// Options that need a whole scene or one renderer.
void check_for_ranks(const RenderArguments& a) {
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given)
      throw Error(Errc::unsupported,
                  std::string(option).append(": cannot be used with several ranks, ").append(why));
  };
  refuse(!a.path.empty(), "--path", "which draw one picture");
  refuse(a.turntable != 0, "--turntable", "which draw one picture");
  refuse(a.time_s.has_value(), "--time", "whose inputs do not move");
  refuse(a.frames.has_value(), "--frames", "which draw one picture");
  refuse(static_cast<bool>(a.outputs.heatmap), "--heatmap", "since each counts its own fragments");
  refuse(static_cast<bool>(a.outputs.errors), "--show-errors", "which blend exactly");
  refuse(static_cast<bool>(a.trace), "--trace", "each of which has its own times");
  refuse(a.render.environment_behind, "--environment-behind", "which do not draw the environment");
  refuse(a.render.rasterizer != "auto", "--rasterizer", "which draw with 'auto'");
  refuse(a.render.visibility != "auto", "--visibility", "which draw with 'auto'");
  for (const std::string& input : a.inputs)
    refuse(parse_input(input).source == "-", "INPUT -",
           "since only one of them could read standard input");
}

std::uint64_t bytes_of(const std::string& input) {
  const std::string source = parse_input(input).source;
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(source, ignored);
  return ignored ? kBuiltinBytes : bytes;
}

/// The begin of each rank's inputs, and the end: runs of about equally many bytes, so that ranks
/// keep the command line's order. Sizes are those that the root sees.
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

std::vector<std::uint64_t> gather(Communicator& ranks, std::uint64_t number) {
  std::vector<std::uint64_t> all;
  for (const auto& bytes : gather_to_all(ranks, std::as_bytes(std::span(&number, 1))))
    std::memcpy(&all.emplace_back(), bytes.data(), sizeof(number));
  return all;
}

}  // namespace

PartJob::PartJob(const RenderArguments& a, RanksOfProgram& program)
    : RenderJob(a, a.quiet || program.ranks().rank() != 0), ranks(program.ranks()) {
  do_alike(ranks, "check options", [&] {
    check_for_ranks(a);
    check(a.render);
    if (is_writer()) check_files(a);
    // Ranks of one machine share its cores.
    if (render.threads == 0)
      render.threads =
          std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / program.neighbours());
    renderer.emplace(static_cast<const RendererOptions&>(render));
  });
  const double begin = timeline.now_ms();
  load();
  load_ms = timeline.now_ms() - begin;
  show_numbers();
  light();
  do_alike(ranks, "bind", [&] { binding.emplace(inputs.scene); });
  render.shader = shader_of(render.shader, inputs.has_materials);
  place_camera();
}

void PartJob::in_writer(std::string_view phase, const std::function<void()>& f) {
  do_alike(ranks, phase, [&] {
    if (is_writer()) f();
  });
}

void PartJob::load() {
  const std::vector<std::uint64_t> firsts = deal(ranks, arguments.inputs);
  const auto me = static_cast<std::size_t>(ranks.rank());
  const std::vector<std::string> names(
      arguments.inputs.begin() + static_cast<std::ptrdiff_t>(firsts[me]),
      arguments.inputs.begin() + static_cast<std::ptrdiff_t>(firsts[me + 1]));
  do_alike(ranks, "load inputs", [&] {
    if (names.empty()) return;
    inputs = load_inputs(names, arguments.normals, timeline, progress, arguments.reading);
    for (const Output* const output : arguments.outputs.asked_for()) check_is_not_read(*output);
    check_is_not_read(arguments.stats);
    set_sizes(inputs.scene, arguments.sizes);
    progress.clear();
    if (arguments.quiet) return;
    for (const std::string& w : inputs.scene.warnings) warn(w);
  });
  agree_on_scene(firsts);
}

/// Makes the ranks' scenes agree like one scene of all inputs: Scene::append adds plain materials,
/// and `auto` depends on all materials.
void PartJob::agree_on_scene(const std::vector<std::uint64_t>& firsts) {
  const bool any_materials = ranks.max(inputs.scene.materials.empty() ? 0 : 1) != 0;
  inputs.has_materials = ranks.max(inputs.has_materials ? 1 : 0) != 0;
  do_alike(ranks, "join scenes", [&] {
    if (any_materials && inputs.scene.materials.empty() && !inputs.scene.instances.empty())
      add_plain_materials(inputs.scene);
  });
  const std::vector<std::uint64_t> instances = gather(ranks, inputs.scene.instances.size());
  std::vector<std::uint64_t> primitives;
  for (const InputPart& part : inputs.parts) primitives.push_back(part.triangles);
  const auto all = gather_to_all(ranks, std::as_bytes(std::span(primitives)));
  do_alike(ranks, "number parts", [&] {
    std::uint64_t first = 0;
    for (int r = 0; r < ranks.rank(); ++r) first += instances[static_cast<std::size_t>(r)];
    for (std::size_t i = 0; i < inputs.scene.instances.size(); ++i)
      instance_ids.push_back(first + i);
    std::uint64_t first_id = 0;
    for (std::size_t r = 0; r < all.size(); ++r) {
      std::vector<std::uint64_t> of_rank(firsts[r + 1] - firsts[r]);
      std::memcpy(of_rank.data(), all[r].data(), all[r].size());
      for (std::size_t i = 0; i < of_rank.size(); ++i) {
        parts.push_back({arguments.inputs[firsts[r] + i], first_id, of_rank[i]});
        rank_of_input.push_back(r);
        first_id += of_rank[i];
      }
    }
  });
}

/// As set_scalars() for one scene.
void PartJob::show_numbers() {
  const ScalarOptions& s = arguments.annotations.scalars;
  if (s.name.empty()) return;
  Scene& scene = inputs.scene;
  const bool known = ranks.max(has_scalars(scene, s.name) ? 1 : 0) != 0;
  do_alike(ranks, "bind", [&] { binding.emplace(scene); });
  Bounds box;
  if (!known && s.name == "distance") box = bounds_of_ranks(ranks, binding->view());
  do_alike(ranks, "show numbers", [&] {
    if (known)
      scene.shown_scalars = s.name;
    else
      show_scalars(scene, s.name, &box);
    scene.scalar_mappings = {s.mapping};
    binding.emplace(scene);
  });
  if (s.isoline_count == 0) return;
  const std::vector<ScalarMapping> mappings = mappings_of_ranks(ranks, binding->view());
  do_alike(ranks, "add isolines",
           [&] { add_isolines(s, ScalarColors(mappings[0], {}).range(), scene); });
}

void PartJob::light() {
  if (!arguments.lights.of_files) return;
  Scene lights;
  lights.lights = lights_of_ranks(ranks, inputs.scene.lights);
  do_alike(ranks, "add lights", [&] { add_file_lights(lights, render.lights); });
}

void PartJob::place_camera() {
  const ViewOptions& v = arguments.view;
  if (v.file_camera) inputs.scene.cameras = cameras_of_ranks(ranks, inputs.scene.cameras);
  FitOfRanks fit(ranks);
  camera = choose_camera(v, inputs.scene, binding->view(), {render.width, render.height}, &fit);
  if (!v.leaves_room()) return;
  Bounds box;
  if (notes.bounds) box = bounds_of_ranks(ranks, binding->view());
  camera = with_room(notes, camera, box, render.width, render.height);
}

}  // namespace rastrum::cli
