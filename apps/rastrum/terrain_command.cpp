// `rastrum terrain (--height FILE | --function NAME) -o OUT`: the options, then check, load, light,
// render, write.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/family.hpp>
#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain.hpp>

#include "annotations.hpp"
#include "arguments.hpp"
#include "camera_path.hpp"
#include "commands.hpp"
#include "ground_options.hpp"
#include "json_fields.hpp"
#include "json_file.hpp"
#include "lit_ground.hpp"
#include "mp4.hpp"
#include "numbered.hpp"
#include "output.hpp"
#include "path_keys.hpp"
#include "progress.hpp"
#include "terrain_objects.hpp"
#include "terrain_options.hpp"
#include "terrain_path.hpp"
#include "timeline.hpp"

namespace rastrum::cli {
namespace {

using terrain::Shadows;
using terrain::TerrainStats;

struct TerrainArguments : TerrainSceneArguments {
  TerrainObjectArguments objects;
  GroundOptions ground;
  WordOptions words;
  std::function<bool(const char*)> given;  ///< whether an option was

  /// The frame options of the ground and of what stands on it: lights, tone, environment.
  [[nodiscard]] FrameOptions& frame() { return objects.scene.render; }
  [[nodiscard]] const FrameOptions& frame() const { return objects.scene.render; }
  std::filesystem::path path;
  std::optional<double> fps;
  std::optional<int> frames;
  bool quiet = false, hash = false;
  Output color, depth, stats;
};

void add_outputs(Parser& app, TerrainArguments& a) {
  const char* group = "Outputs";
  add(app, "-o,--output", "FILE",
      ".png: 8 bit; with --path also .mp4; - is standard output, here and below",
      [&a](const std::string& s) {
        a.color = parse_output("-o", s, {Format::png, Format::mp4});
      })
      ->group(group);
  add(app, "--depth", "FILE", ".npy or .exr: float32, cells along the view, inf where the sky is",
      [&a](const std::string& s) {
        a.depth = parse_output("--depth", s, {Format::npy, Format::exr});
      })
      ->group(group);
  add(app, "--stats", "FILE", ".json: counts, memory and times", [&a](const std::string& s) {
    a.stats = parse_output("--stats", s, {Format::json});
  })->group(group);
  app.add_flag("--hash", a.hash,
               "print the digest (SHA-256, docs/conventions.md) of the pixels of each picture that "
               "is written, or without any of the 8-bit colours")
      ->group(group);
  app.add_flag("--quiet", a.quiet, "print errors alone")->group(group);
}

void add_path(Parser& app, TerrainArguments& a) {
  const char* group = "Camera path";
  add(app, "--path", "FILE",
      "draw a picture for each moment of a camera path (docs/window.md): -o 'frame_%04d.png' or, "
      "through ffmpeg, -o flight.mp4",
      [&a](const std::string& s) { a.path = s; })
      ->group(group);
  add(app, "--fps", "N", "pictures a second of the path (30)", [&a](const std::string& s) {
    a.fps = parse_number("--fps", s);
    if (!(*a.fps > 0 && *a.fps <= 1000)) throw UsageError("--fps", "must lie in 0 to 1000");
  })->group(group);
}

void add_frames(Parser& app, TerrainArguments& a) {
  add(app, "--frames", "N", "render N times; --stats gives median, minimum and maximum (1)",
      [&a](const std::string& s) { a.frames = parse_integer("--frames", s, 1, 1000000); })
      ->group("Machine");
}

void check_path(const TerrainArguments& a) {
  if (a.frames)
    throw UsageError("--frames", "leaves no room for --path: both say how many frames are drawn");
  for (const Output* const output : {&a.color, &a.depth}) {
    if (!*output) continue;
    if (output->format == Format::mp4)
      Mp4Writer::check(a.options.width, a.options.height);
    else
      static_cast<void>(NumberedName(output->option, output->file.string()));
  }
  static_cast<void>(read_json(a.path));  // a spoilt file is refused before a large map is read
}

/// Throws where outputs cannot be written. Called again once the inputs have told which files they
/// name.
void check_files(const TerrainArguments& a) {
  const Output* const outputs[] = {&a.color, &a.depth, &a.stats};
  check_outputs(outputs);
  if (a.hash) check_hash(outputs);
}

void check(TerrainArguments& a) {
  if (!a.color && !a.depth && !a.stats && !a.hash)
    throw UsageError("-o", "say where the picture goes, as in -o picture.png");
  if (a.path.empty() && a.fps) throw UsageError("--fps", "is for --path");
  if (a.path.empty() && a.color && a.color.format == Format::mp4)
    throw UsageError("-o", "an .mp4 is drawn along a camera path: give --path");
  if (!a.path.empty()) check_path(a);
  check_terrain_objects(a.objects, a.options);
  check_ground(a.ground, a, a.frame(), a.objects.scene.lights, a.color || a.hash, a.given);
  check_words(a.words, a.color || a.hash);
  if (a.words.scale_given && !a.words.any() && !a.ground.draws())
    throw UsageError("--text-scale", "is for --title, --caption, --bar, --axes and --bounds");
  check_files(a);
}

nlohmann::ordered_json terrain_stats(std::vector<TerrainStats> frames, const TerrainArguments& a,
                                     const LoadedTerrain& source, double load_ms, double light_ms) {
  std::ranges::sort(frames, {}, &TerrainStats::frame_ms);
  const TerrainStats& median = frames[(frames.size() - 1) / 2];
  const bool serial = median.device == Device::serial;
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const StageTime& stage : median.stages) {
    nlohmann::ordered_json& ms = stages[stage.name];
    ms = (ms.is_null() ? 0.0 : ms.get<double>()) + (stage.end_ms - stage.begin_ms);
  }
  return {{"version", RASTRUM_VERSION},
          {"device", name(median.device)},
          {"device_why", median.device_why},
          {"threads", serial ? 1 : parallel::Threads(a.options.threads).concurrency()},
          {"isa", name(median.isa)},
          {"size", {a.options.width, a.options.height}},
          {"map", {source.width(), source.height()}},
          {"heights", {source.lowest(), source.highest()}},
          {"camera",
           {{"x", median.camera.x}, {"y", median.camera.y}, {"altitude", median.camera.altitude}}},
          {"slices", median.slices},
          {"samples", median.samples},
          {"visible", median.visible},
          {"peak_bytes", median.peak_bytes},
          {"device_bytes", median.device_bytes},
          {"load_ms", load_ms},
          {"light_ms", light_ms},
          {"stages_ms", std::move(stages)},
          {"frame_ms",
           {{"median", median.frame_ms},
            {"min", frames.front().frame_ms},
            {"max", frames.back().frame_ms},
            {"frames", frames.size()}}}};
}

/// A lit terrain and what draws it; times of loading and lighting for the statistics.
struct Stage {
  const TerrainArguments& arguments;
  const LoadedTerrain& source;
  LitGround& ground;
  terrain::TerrainRenderer& renderer;
  const terrain::TerrainOptions& options;
  TerrainObjects* objects;  ///< null: none
  double load_ms, light_ms;

  /// Whether a picture needs the depth of its ground.
  [[nodiscard]] bool needs_depth() const {
    return objects != nullptr || arguments.frame().environment_behind || arguments.ground.bounds;
  }
};

/// The terrain, what is around it and what stands on it. Colours alone are timed, but for what
/// needs the depth.
struct TerrainPictures {
  Image<Rgba8> color;
  Image<float> depth;

  TerrainPictures(const Stage& stage, bool wants_depth)
      : color(stage.options.width, stage.options.height) {
    if (wants_depth || stage.needs_depth()) depth = Image<float>(color.width(), color.height());
  }
  TerrainStats draw(const Stage& stage, const terrain::TerrainCamera& camera) {
    terrain::TerrainTargets targets{.color8 = color.view()};
    if (stage.needs_depth()) targets.depth = depth.view();
    TerrainStats stats =
        stage.renderer.render(stage.ground.seen_from(camera), camera, stage.options, targets);
    const FrameOptions& frame = stage.arguments.frame();
    if (frame.environment_behind) {
      Timeline timeline;
      const int threads =
          stage.arguments.options.device == Device::serial ? 1 : stage.arguments.options.threads;
      draw_environment_behind(frame.lights, frame.tone, stage.options, stats.camera, targets,
                              threads);
      const double begin_ms = stats.frame_ms;
      stats.frame_ms += timeline.now_ms();
      stats.stages.push_back({"environment", begin_ms, stats.frame_ms});
    }
    if (stage.objects != nullptr) stage.objects->draw(targets, stats);
    return stats;
  }
  /// Requires draw() of the same frame, which leaves the depth where something needs it.
  void write_depth(const Stage& stage, const terrain::TerrainCamera& camera, const Output& output,
                   OutputFiles& files) {
    if (!stage.needs_depth())
      stage.renderer.render(stage.ground.terrain(), camera, stage.options, {.depth = depth.view()});
    write_image(files.begin(output), output.format, depth.view());
  }
  /// `camera`: as drawn.
  void annotate(const Stage& stage, const terrain::TerrainCamera& camera) {
    terrain::TerrainTargets picture{.color8 = color.view()};
    if (stage.needs_depth()) picture.depth = depth.view();
    const GroundOptions& ground = stage.arguments.ground;
    draw_ground_annotations(meant(ground, stage.source, meant(stage.arguments.words)),
                            stage.ground.terrain(), numbers_of(ground, stage.source), stage.options,
                            camera, picture);
  }
  /// `number`: of a picture of many.
  void print_hashes(const TerrainArguments& a, std::optional<std::size_t> number) const {
    if (!a.hash) return;
    if (a.color || !a.depth) print_hash(digest(color), "color", number);
    if (a.depth) print_hash(digest(depth), "depth", number);
  }
};

/// The output that is of the whole run.
void write_stats(const TerrainArguments& a, const Stage& stage, std::vector<TerrainStats> frames,
                 OutputFiles& files) {
  if (!a.stats) return;
  nlohmann::ordered_json json =
      terrain_stats(std::move(frames), a, stage.source, stage.load_ms, stage.light_ms);
  if (stage.objects != nullptr) json["objects"] = {{"triangles", stage.objects->triangles()}};
  write_json(files.begin(a.stats), json);
}

int run_path(const TerrainArguments& a, const Stage& stage, const terrain::TerrainCamera& base,
             Progress& progress) {
  constexpr double kDefaultFps = 30;
  const double fps = a.fps.value_or(kDefaultFps);
  const TerrainPath path = read_terrain_path(a.path, base);
  const std::vector<double> times =
      of_path(a.path, [&] { return frame_times(path.first_s(), path.last_s(), fps); });
  const std::size_t count = times.size();
  // Names are refused before anything is drawn.
  const Output* const of_pictures[] = {&a.color, &a.depth};
  const Output* const of_run[] = {&a.stats};
  check_numbered(of_pictures, of_run, count);
  OutputFiles of_the_run;  // each picture's own files are seen as soon as it is drawn
  std::unique_ptr<Mp4Writer> video;
  if (a.color && a.color.format == Format::mp4)
    video = std::make_unique<Mp4Writer>(of_the_run.begin(a.color), a.options.width,
                                        a.options.height, fps);

  TerrainPictures pictures(stage, static_cast<bool>(a.depth));
  std::vector<TerrainStats> frames;
  for (std::size_t i = 0; i < count; ++i) {
    progress.show("picture " + std::to_string(i + 1) + " of " + std::to_string(count));
    const terrain::TerrainCamera camera = path.at(times[i]);
    frames.push_back(pictures.draw(stage, camera));
    pictures.annotate(stage, frames.back().camera);
    OutputFiles files;
    if (video)
      video->add(pictures.color.view());
    else if (a.color)
      io::write_png(files.begin(numbered(a.color, i, count)), pictures.color.view());
    if (a.depth) pictures.write_depth(stage, camera, numbered(a.depth, i, count), files);
    progress.clear();
    pictures.print_hashes(a, i);
    files.commit();
  }
  if (video) video->finish();
  progress.clear();
  write_stats(a, stage, std::move(frames), of_the_run);
  of_the_run.commit();
  if (!a.quiet && a.color)
    std::fprintf(stderr, "%s: %lu pictures of %dx%d\n", a.color.name().c_str(),
                 static_cast<unsigned long>(count), a.options.width, a.options.height);
  return 0;
}

int run(TerrainArguments& a) {
  check(a);
  settle(a);
  FrameOptions& frame = a.frame();
  frame.shadows = !frame.lights.empty() && a.light.shadows != Shadows::none;
  if (frame.lights.empty()) a.options.sky = sky_of(a.options, a.light.sun, a.sky_dims || a.dim_sky);
  Timeline timeline;
  Progress progress(a.quiet);
  // Refuses what cannot be drawn before a large file is read.
  terrain::check(a.options);
  terrain::TerrainRenderer renderer(a.options);

  progress.show("loading");
  std::optional<TerrainObjects> objects;
  if (!a.objects.objects.empty()) objects.emplace(a.objects, a.options, timeline, progress);
  progress.show("loading");
  LoadedTerrain source(a.input);
  check_files(a);
  if (!a.ground.heights.name.empty()) source.show_numbers(a.ground.heights.mapping, a.options);
  if (!a.quiet && !source.scale_note().empty()) {
    progress.clear();
    note(source.scale_note());
  }
  if (!a.quiet) report_missing_glyphs(a.words);
  const double load_ms = timeline.now_ms();
  progress.show("lighting");
  const terrain::TerrainCamera camera = camera_of(a, source);
  // Far ground in fog becomes what is behind it.
  if (frame.environment_behind) a.options.sky = horizon_color(frame.lights, frame.tone, camera);
  LitGround ground(source, a.options, a.light, frame, camera);
  if (objects) {
    objects->place(ground.terrain());
    if (!a.quiet && !objects->warnings().empty()) {
      progress.clear();
      for (const std::string& w : objects->warnings()) warn(w);
    }
  }
  const Stage stage{a,         source,
                    ground,    renderer,
                    a.options, objects ? &*objects : nullptr,
                    load_ms,   timeline.now_ms() - load_ms};
  if (!a.path.empty()) return run_path(a, stage, camera, progress);

  TerrainPictures pictures(stage, static_cast<bool>(a.depth));
  std::vector<TerrainStats> frames;
  const int count = a.frames.value_or(1);
  for (int i = 0; i < count; ++i) {
    progress.show("rendering frame " + std::to_string(i + 1) + " of " + std::to_string(count));
    frames.push_back(pictures.draw(stage, camera));
  }
  pictures.annotate(stage, frames.back().camera);
  OutputFiles files;
  if (a.color) io::write_png(files.begin(a.color), pictures.color.view());
  if (a.depth) pictures.write_depth(stage, camera, a.depth, files);
  progress.clear();
  pictures.print_hashes(a, {});
  const auto fastest = std::ranges::min(frames, {}, &TerrainStats::frame_ms).frame_ms;
  write_stats(a, stage, std::move(frames), files);
  files.commit();
  if (!a.quiet && a.color)
    std::fprintf(stderr, "%s: %dx%d, map %dx%d, %.1f ms%s\n", a.color.name().c_str(),
                 a.options.width, a.options.height, source.width(), source.height(), fastest,
                 count > 1 ? " the fastest frame" : "");
  return 0;
}

}  // namespace

Command add_terrain_command(Parser& app) {
  auto arguments = std::make_shared<TerrainArguments>();
  Parser command =
      app.add_subcommand("terrain", "Fly over a height map or a function (Voxel Space)");
  add_terrain_inputs(command, *arguments);
  add_outputs(command, *arguments);
  add_terrain_camera(command, *arguments);
  add_path(command, *arguments);
  add_terrain_picture(command, *arguments);
  add_terrain_light(command, *arguments);
  add_ground_lights(command, arguments->frame(), arguments->objects.scene.lights);
  add_terrain_objects(command, arguments->objects);
  add_ground_options(command, arguments->ground);
  add_word_options(command, arguments->words, "Words");
  add_terrain_machine(command, *arguments);
  add_frames(command, *arguments);
  std::string footer = "Functions:\n";
  for (const terrain::FunctionInfo& f : terrain::named_functions())
    footer.append("  ").append(f.name).append("\n      ").append(f.description).append("\n");
  footer +=
      "\nA cell is a pixel of the height map; heights, distances and positions are in cells.\n"
      "Times: a frame goes from the lit map in memory to the finished image in memory; load_ms "
      "and\n"
      "light_ms come before, once.\n"
      "\nExamples:\n"
      "  rastrum terrain --height D1.png --color C1W.png -o flight.png\n"
      "  rastrum terrain --height D1.png --color C1W.png --classic --size 800x450 -o original.png\n"
      "  rastrum terrain --height SainteHelens.dem --sun 250,25 --shadows sharp -o h.png\n"
      "  rastrum terrain --height alps.png --light environment:sky --light "
      "directional:1,-1,0.5:intensity=2 --tone aces --shadows sharp --environment-behind -o "
      "sky.png\n"
      "  rastrum terrain --height h.dem --cmap viridis --steps 10 --bar Height --bar-unit m "
      "--bounds "
      "-o map.png\n"
      "  rastrum terrain --function noise --filter bilinear --fog 0.002 --distance 2000 -o "
      "noise.png\n"
      "  rastrum terrain --function '30*sin(x/40)*cos(y/40)' --altitude 60 -o eggs.png\n"
      "  rastrum terrain --height map.npy --filter mip --frames 20 --stats - -o map.png\n"
      "  rastrum terrain --function noise --path flight.json --fps 60 -o 'frame_%04d.png'\n"
      "  rastrum terrain --height D1.png --mesh 'tower.obj@x=510,y=640,scale=3' --opacity 0.5 \\\n"
      "      --sprite 'tree.png@x=500,y=700,size=9' -o inhabited.png";
  command.footer(footer);
  return {command, [arguments, command] {
            arguments->given = [command](const char* option) { return command.given(option); };
            return run(*arguments);
          }};
}

}  // namespace rastrum::cli
