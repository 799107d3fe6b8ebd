// SPDX-License-Identifier: BSD-3-Clause
#include "large_job.hpp"

#include <filesystem>
#include <string>
#include <string_view>

#include <rastrum/effects.hpp>
#include <rastrum/error.hpp>

#include "camera.hpp"

namespace rastrum::cli {
namespace {

/// If none is given.
constexpr std::uint64_t kUsualLimit = std::uint64_t{2} << 30;
/// A smaller limit is meant for scratch; the file is read then.
constexpr std::uint64_t kLeastLimit = std::uint64_t{64} << 20;

void check_options(const RenderArguments& a) {
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given)
      throw Error(Errc::unsupported, std::string(option).append(": not out of core, ").append(why));
  };
  const char* const one = "which draws one picture; --out-of-core never reads the file";
  refuse(!a.path.empty(), "--path", one);
  refuse(a.turntable != 0, "--turntable", one);
  refuse(a.time_s.has_value(), "--time", "where nothing moves");
  refuse(a.frames.has_value(), "--frames", one);
  refuse(static_cast<bool>(a.trace), "--trace",
         "whose chunks are too many to list; --stats sums up");
  refuse(static_cast<bool>(a.outputs.heatmap), "--heatmap", "which leaves out what is hidden");
  refuse(static_cast<bool>(a.outputs.errors), "--show-errors", "which blends exactly");
  refuse(a.view.file_camera.has_value(), "--camera", "which leaves the cameras of files alone");
  refuse(a.lights.of_files, "--lights file", "which leaves the lights of files alone");
  refuse(a.render.shadows, "--shadows", "since what is not seen casts shadows, too");
  refuse(a.render.shader == Shader::id, "--shader id", "which draws other ids; take --ids");
  refuse(a.render.device != Device::threads && a.render.device != Device::serial, "--device",
         "whose frames are the CPU's");
  refuse(a.render.rasterizer != "auto", "--rasterizer", "which draws with 'auto'");
  refuse(a.render.visibility != "auto", "--visibility", "which draws with 'auto'");
  refuse(
      a.render.transparency.method == Transparency::added && filter_of(a.render.transparency) == 0,
      "--transparency", "which blends by exact, filter, unsorted or none");
  const AnnotationOptions& notes = a.annotations;
  refuse(!notes.scalars.name.empty(), "--scalars", "since numbers have a range of the whole file");
  refuse(notes.bounds, "--bounds", "which knows a part of the mesh at a time");
  refuse(notes.edges, "--edges", "since what is not seen has edges, too");
  refuse(!a.reading.options.allow_outside, "--allow-outside no",
         "which reads what a file names; --out-of-core never reads the file so");
  refuse(a.inputs.size() != 1, "INPUT", "which draws one file");
}

std::uint64_t limit_of(const RenderArguments& a) {
  return a.render.memory_limit == 0 ? kUsualLimit : a.render.memory_limit;
}

}  // namespace

std::optional<OutOfCoreFile> large_input(const RenderArguments& a) {
  if (a.out_of_core == OutOfCore::never) return {};
  if (a.out_of_core == OutOfCore::always) {
    check_options(a);
    return OutOfCoreFile(parse_input(a.inputs[0]).source, limit_of(a));
  }
  const std::uint64_t limit = a.render.memory_limit;
  if (limit < kLeastLimit || a.inputs.size() != 1) return {};
  const std::filesystem::path file = parse_input(a.inputs[0]).source;
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(file, ignored);
  if (ignored || bytes < limit / 4) return {};
  try {
    OutOfCoreFile large(file, limit);
    if (large.bytes_in_memory() <= limit) return {};
    check_options(a);
    return large;
  } catch (const Error& e) {
    if (std::string_view(e.what()).find("out of core: ") == std::string_view::npos) throw;
    // A small file with much beside its triangles (LargeFile::bytes_beside) may take more memory
    // out of core than read whole.
    const bool is_small = e.code() == Errc::out_of_memory && bytes <= limit;
    if (e.code() != Errc::unsupported && !is_small) throw;
    if (!a.quiet) warn(std::string(e.what()).append("; it is read, beyond the memory limit"));
    return {};
  }
}

LargeJob::LargeJob(const RenderArguments& a, const OutOfCoreFile& mapped)
    : RenderJob(a, a.quiet), file(mapped) {
  check(a.render);
  parts = {{a.inputs[0], 0, file.triangles()}};
  options.memory_limit = limit_of(a);
  options.renderer = a.render;
  options.renderer.memory_limit = 0;
  options.prepare = [&a](Scene& scene) { finish_input(scene, a.inputs[0], a.normals); };
  options.neighbours = a.normals.kind == Normals::crease || a.normals.kind == Normals::vertex ||
                       (a.normals.kind == Normals::file && !file.has_normals());
  options.progress = [this](std::string_view what, std::uint64_t done, std::uint64_t all) {
    progress.show(what, done, all);
  };
  render.shader = shader_of(render.shader, file.has_materials());

  progress.show("looking for the view");
  const double begin = timeline.now_ms();
  FitOfFile fit(file, options.prepare, options.renderer.threads);
  camera = choose_camera(a.view, Scene{}, SceneView{}, {render.width, render.height}, &fit);
  if (notes.occlusion && notes.occlusion->radius == 0)
    notes.occlusion->radius = 0.15 * bounding_sphere(SceneView{}, &fit).radius;
  fit_ms = timeline.now_ms() - begin;
}

}  // namespace rastrum::cli
