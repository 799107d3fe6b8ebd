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
      throw Error(Errc::unsupported,
                  std::string(option).append(": cannot be used out of core, ").append(why));
  };
  const char* const one = "where one picture is drawn; `--out-of-core never` reads the whole file";
  refuse(!a.path.empty(), "--path", one);
  refuse(a.turntable != 0, "--turntable", one);
  refuse(a.time_s.has_value(), "--time", "where nothing moves");
  refuse(a.frames.has_value(), "--frames", one);
  refuse(static_cast<bool>(a.trace), "--trace",
         "where the chunks are too many to list; --stats sums up");
  refuse(static_cast<bool>(a.outputs.heatmap), "--heatmap", "where hidden fragments are left out");
  refuse(static_cast<bool>(a.outputs.errors), "--show-errors",
         "where every pixel is blended exactly");
  refuse(a.view.file_camera.has_value(), "--camera", "where the cameras of files are not read");
  refuse(a.lights.of_files, "--lights file", "where the lights of files are not read");
  refuse(a.render.shadows, "--shadows", "since triangles that are not seen cast shadows, too");
  refuse(a.render.shader == Shader::id, "--shader id", "where ids are numbered anew; take --ids");
  refuse(a.render.device != Device::threads && a.render.device != Device::serial, "--device",
         "where the CPU draws");
  refuse(a.render.rasterizer != "auto", "--rasterizer", "where 'auto' draws");
  refuse(a.render.visibility != "auto", "--visibility", "where 'auto' draws");
  refuse(
      a.render.transparency.method == Transparency::added && filter_of(a.render.transparency) == 0,
      "--transparency", "where the methods are exact, filter:K, unsorted and none");
  const AnnotationOptions& notes = a.annotations;
  refuse(!notes.scalars.name.empty(), "--scalars",
         "since the range of the numbers needs the whole file");
  refuse(notes.bounds, "--bounds", "where only a part of the mesh is known at a time");
  refuse(notes.edges, "--edges", "since triangles that are not seen have edges, too");
  refuse(!a.reading.options.allow_outside, "--allow-outside no",
         "where the files that a file names are read; `--out-of-core never` obeys it");
  refuse(a.inputs.size() != 1, "INPUT", "where one file is drawn");
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
    if (!a.quiet)
      warn(std::string(e.what()).append("; the file is read whole, beyond the memory limit"));
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
