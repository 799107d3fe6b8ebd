#include "render_out_of_core.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include <rastrum/effects.hpp>
#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "annotations.hpp"
#include "camera_path.hpp"
#include "input_spec.hpp"
#include "inputs.hpp"
#include "json_file.hpp"
#include "picture_files.hpp"
#include "progress.hpp"
#include "render_outputs.hpp"
#include "stats_json.hpp"
#include "timeline.hpp"
#include "transparency.hpp"
#include "view.hpp"

namespace rastrum::cli {
namespace {

/// Where nobody says how much.
constexpr std::uint64_t kUsualLimit = std::uint64_t{2} << 30;
/// Smaller limits are of those who draw in little scratch.
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
  refuse(a.frames_given, "--frames", one);
  refuse(static_cast<bool>(a.trace), "--trace",
         "whose chunks are too many to list; --stats sums up");
  refuse(static_cast<bool>(a.heatmap), "--heatmap", "which leaves out what is hidden");
  refuse(static_cast<bool>(a.errors), "--show-errors", "which blends exactly");
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

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20).append(" MiB");
}

/// The number of rows of the picture that are drawn at once; 0: all. Throws where the picture must
/// be whole and does not fit into `limit`.
int rows_of(const RenderArguments& a, const Annotations& notes, std::uint64_t limit) {
  const int rows = rows_at_once(a, limit / 4);
  if (rows == 0) return 0;
  const char* const why = why_whole(a, notes);
  if (why == nullptr) return rows;
  if (rows_at_once(a, limit) != 0)
    throw Error(Errc::out_of_memory,
                std::string("--memory-limit: ")
                    .append(mebibytes(limit))
                    .append(" hold no picture of ")
                    .append(std::to_string(a.render.width))
                    .append("x")
                    .append(std::to_string(a.render.height))
                    .append(", and ")
                    .append(why)
                    .append(" a whole picture; without (--look plain) it is drawn in bands"));
  return 0;
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
    // out of core than if it is read whole.
    const bool is_small = e.code() == Errc::out_of_memory && bytes <= limit;
    if (e.code() != Errc::unsupported && !is_small) throw;
    if (!a.quiet) warn(std::string(e.what()).append("; it is read, beyond the memory limit"));
    return {};
  }
}

int render_out_of_core(RenderArguments& a, const OutOfCoreFile& file, Timeline& timeline,
                       Progress& progress) {
  rastrum::check(a.render);
  OutOfCoreOptions options;
  options.memory_limit = limit_of(a);
  options.renderer = a.render;
  options.renderer.memory_limit = 0;
  options.prepare = [&](Scene& scene) { finish_input(scene, a.inputs[0], a.normals); };
  options.neighbours = a.normals.kind == Normals::crease || a.normals.kind == Normals::vertex ||
                       (a.normals.kind == Normals::file && !file.has_normals());
  options.progress = [&](std::string_view what, std::uint64_t done, std::uint64_t all) {
    const std::uint64_t percent = 100 * done / std::max<std::uint64_t>(all, 1);
    progress.show(std::string(what).append(": ").append(std::to_string(percent)).append(" %"));
  };
  a.render.shader = shader_of(a.render.shader, file.has_materials());

  progress.show("looking for the view");
  const double begin = timeline.now_ms();
  FitOfFile fit(file, options.prepare, options.renderer.threads);
  const Camera camera =
      choose_camera(a.view, Scene{}, SceneView{}, {a.render.width, a.render.height}, &fit);
  Annotations notes = meant(a.annotations);
  if (notes.occlusion && notes.occlusion->radius == 0)
    notes.occlusion->radius = 0.15 * bounding_sphere(SceneView{}, &fit).radius;
  const double fit_ms = timeline.now_ms() - begin;

  Annotator annotator(a.render.threads, a.render.isa);
  Pictures pictures;
  Inputs inputs;
  inputs.parts.push_back({a.inputs[0], 0, file.triangles()});
  OutputFiles files;
  std::optional<PictureFiles> in_bands;
  FrameOptions held = a.render;
  if (options.rows = rows_of(a, notes, options.memory_limit); options.rows != 0) {
    held.height = options.rows;
    in_bands.emplace(a, camera, inputs, files);
    options.take_rows = [&](int first, int last) { in_bands->add(pictures, last - first); };
  }
  const Targets targets = make_targets(wanted_of(a, &notes, &annotator), held, pictures);
  const double drawing = timeline.now_ms();
  const OutOfCoreStats stats = file.render(camera, a.render, targets, options);
  const double ms = timeline.now_ms() - drawing;
  progress.clear();
  if (!a.quiet && stats.dropped != 0)
    warn(std::to_string(stats.dropped) + " of " + std::to_string(stats.triangles) +
         " triangles have a NaN or infinite vertex and are not drawn");
  if (!a.quiet && stats.seen == 0) warn("nothing is seen: no triangle is in the view");

  if (in_bands) {
    in_bands->finish();
  } else {
    annotate_pictures(a, notes, pictures, SceneView{}, camera, annotator);
    write_images(a, pictures, camera, inputs, {}, files, timeline, progress);
  }
  progress.clear();
  if (a.stats) {
    FrameStats frame = stats.frame;
    frame.triangles.input = stats.triangles;
    frame.triangles.dropped = stats.dropped;
    frame.frame_ms = ms;
    nlohmann::ordered_json json = stats_json({&frame, 1}, a.render, 0);
    json["out_of_core"] = {{"chunk_triangles", stats.chunk},
                           {"chunks", stats.chunks},
                           {"skipped", stats.skipped},
                           {"seen_triangles", stats.seen},
                           {"bands", stats.bands},
                           {"fit_ms", fit_ms},
                           {"draw_ms", ms}};
    json["inputs"] = {{{"name", a.inputs[0]}, {"first_id", 0}, {"triangles", stats.triangles}}};
    json["cameras"] = {camera_json(camera, true)};
    write_json(files.begin(a.stats), json);
  }
  files.commit();
  if (!a.quiet && a.color)
    std::fprintf(
        stderr, "%s: %dx%d, %llu triangles, %llu of them drawn, %.1f ms out of core in %s\n",
        a.color.name().c_str(), a.render.width, a.render.height,
        static_cast<unsigned long long>(stats.triangles),
        static_cast<unsigned long long>(stats.seen), ms, mebibytes(options.memory_limit).c_str());
  return 0;
}

}  // namespace rastrum::cli
