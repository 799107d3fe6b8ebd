// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
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
#include <rastrum/version.hpp>

#include "commands.hpp"
#include "files/mp4.hpp"
#include "files/output_files.hpp"
#include "frame/stats_json.hpp"
#include "frame/terrain_objects.hpp"
#include "job/camera_path.hpp"
#include "job/ground.hpp"
#include "job/json_file.hpp"
#include "job/path_keys.hpp"
#include "job/progress.hpp"
#include "job/terrain_path.hpp"
#include "parse/annotations.hpp"
#include "parse/arguments.hpp"
#include "parse/ground_options.hpp"
#include "parse/output.hpp"
#include "parse/terrain_options.hpp"

namespace rastrum::cli {
namespace {

using terrain::Shadows;
using terrain::TerrainStats;

struct TerrainArguments : TerrainSceneArguments, RunOptions {
  TerrainObjectArguments objects;
  GroundOptions ground;
  WordOptions words;
  std::function<bool(const char*)> given;  ///< whether an option was given

  /// The frame options of the ground and of the objects on it: lights, tone, environment.
  [[nodiscard]] FrameOptions& frame() { return objects.scene.render; }
  [[nodiscard]] const FrameOptions& frame() const { return objects.scene.render; }
  Output color, depth;
};

void add_outputs(Parser app, TerrainArguments& a) {
  app = app.under("Outputs");
  add(app, "-o,--output", "FILE",
      "the picture, .png: 8 bit; with --path also .mp4; - is standard output, here and below",
      [&a](const std::string& s) {
        a.color = parse_output("-o", s, {Format::png, Format::mp4});
      });
  add_output(app, "--depth",
             "distance along the view in cells, .npy or .exr: float32, inf where the sky is",
             a.depth, {Format::npy, Format::exr});
  add_output(app, "--stats", "counts, memory and times, .json", a.stats, {Format::json});
  add_hash_option(app, a);
  app.add_flag("--quiet", a.quiet, "print only errors");
}

void check_path(const TerrainArguments& a) {
  if (a.frames)
    throw UsageError("--frames", "cannot go with --path: both say how many frames are drawn");
  if (a.color.is_film()) Mp4Writer::check(a.options.width, a.options.height);
  for (const Output* const output : {&a.color, &a.depth})
    static_cast<void>(numbered(*output, 0, 1));  // throws for a wrong %d
  static_cast<void>(read_json(a.path));          // refuses a wrong file before a large map is read
}

/// Throws if outputs cannot be written. Called again once the inputs have named their files.
void check_files(const TerrainArguments& a) {
  const Output* const outputs[] = {&a.color, &a.depth, &a.stats};
  check_outputs(outputs, a.hash);
}

void check(TerrainArguments& a) {
  if (!a.color && !a.depth && !a.stats && !a.hash)
    throw UsageError("-o", "say where the picture goes, as in -o picture.png");
  if (a.path.empty() && a.fps) throw UsageError("--fps", "needs --path");
  if (a.path.empty() && a.color.is_film())
    throw UsageError("-o", "an .mp4 needs several pictures: give --path");
  if (!a.path.empty()) check_path(a);
  check_terrain_objects(a.objects, a.options);
  check_ground(a.ground, a, a.frame(), a.objects.scene.lights, a.color || a.hash, a.given);
  check_words(a.words, a.color || a.hash);
  if (a.words.scale_given && !a.words.any() && !a.ground.draws())
    throw UsageError("--text-scale",
                     "scales --title, --caption, --bar, --axes and --bounds; give one of them");
  check_files(a);
}

/// A lit terrain and its pictures. Only colours are timed, and the depth if they need it.
struct TerrainPictures {
  const TerrainArguments& arguments;
  const LoadedTerrain& source;
  LitGround& ground;
  terrain::TerrainRenderer& renderer;
  TerrainObjects* objects;  ///< may be null
  double load_ms, light_ms;
  Image<Rgba8> color{arguments.options.width, arguments.options.height};
  Image<float> depth = arguments.depth || needs_depth()
                           ? Image<float>(color.width(), color.height())
                           : Image<float>();

  [[nodiscard]] bool needs_depth() const {
    return objects != nullptr || arguments.frame().environment_behind || arguments.ground.bounds;
  }
  [[nodiscard]] terrain::TerrainTargets targets() {
    terrain::TerrainTargets all{.color8 = color.view()};
    if (needs_depth()) all.depth = depth.view();
    return all;
  }
  TerrainStats draw(const terrain::TerrainCamera& camera) {
    const terrain::TerrainTargets picture = targets();
    const TerrainLook& options = arguments.options;
    TerrainStats stats = renderer.render(ground.seen_from(camera), camera, options, picture);
    const FrameOptions& frame = arguments.frame();
    if (frame.environment_behind) {
      Timeline timeline;
      draw_environment_behind(frame.lights, frame.tone, options, stats.camera, picture,
                              options.device == Device::serial ? 1 : options.threads);
      const double begin_ms = stats.frame_ms;
      stats.frame_ms += timeline.now_ms();
      stats.stages.push_back({"environment", begin_ms, stats.frame_ms});
    }
    if (objects != nullptr) objects->draw(picture, stats);
    return stats;
  }
  /// Requires draw() of the same frame, which fills the depth if something needs it.
  void write_depth(const terrain::TerrainCamera& camera, const Output& output, OutputFiles& files) {
    if (!needs_depth())
      renderer.render(ground.terrain(), camera, arguments.options, {.depth = depth.view()});
    write_image(files.begin(output), output.format, depth.view());
  }
  /// `camera`: as drawn.
  void annotate(const terrain::TerrainCamera& camera) {
    draw_ground_annotations(meant(arguments.ground, source, meant(arguments.words)),
                            ground.terrain(), numbers_of(arguments.ground, source),
                            arguments.options, camera, targets());
  }
  /// `number`: of this picture among many.
  void print_hashes(std::optional<std::size_t> number) const {
    const TerrainArguments& a = arguments;
    if (!a.hash) return;
    if (a.color || !a.depth) print_hash(digest(color), "color", number);
    if (a.depth) print_hash(digest(depth), "depth", number);
  }
};

nlohmann::ordered_json terrain_stats(const TerrainPictures& pictures,
                                     std::vector<TerrainStats> frames) {
  const TerrainArguments& a = pictures.arguments;
  std::ranges::sort(frames, {}, &TerrainStats::frame_ms);
  const TerrainStats& median = frames[(frames.size() - 1) / 2];
  const bool serial = median.device == Device::serial;
  nlohmann::ordered_json json{
      {"version", version()},
      {"device", name(median.device)},
      {"device_why", median.device_why},
      {"threads", serial ? 1 : parallel::Threads(a.options.threads).concurrency()},
      {"isa", name(median.isa)},
      {"size", {a.options.width, a.options.height}},
      {"map", {pictures.source.width(), pictures.source.height()}},
      {"heights", {pictures.source.lowest(), pictures.source.highest()}},
      {"camera",
       {{"x", median.camera.x}, {"y", median.camera.y}, {"altitude", median.camera.altitude}}},
      {"slices", median.slices},
      {"samples", median.samples},
      {"visible", median.visible},
      {"peak_bytes", median.peak_bytes},
      {"device_bytes", median.device_bytes},
      {"load_ms", pictures.load_ms},
      {"light_ms", pictures.light_ms},
      {"stages_ms", stages_json(median.stages)},
      {"frame_ms",
       {{"median", median.frame_ms},
        {"min", frames.front().frame_ms},
        {"max", frames.back().frame_ms},
        {"frames", frames.size()}}}};
  if (pictures.objects != nullptr) json["objects"] = {{"triangles", pictures.objects->triangles()}};
  return json;
}

/// Along --path, or one camera.
std::vector<terrain::TerrainCamera> cameras_of(const TerrainArguments& a,
                                               const terrain::TerrainCamera& base) {
  if (a.path.empty()) return {base};
  const TerrainPath path = read_path(a.path, base);
  std::vector<terrain::TerrainCamera> cameras;
  for (const double t : of_path(a.path, [&] {
         return frame_times(path.first_s(), path.last_s(), a.pictures_a_second());
       }))
    cameras.push_back(path.at(t));
  return cameras;
}

void write_pictures(TerrainPictures& pictures, const std::vector<terrain::TerrainCamera>& cameras,
                    Progress& progress) {
  const TerrainArguments& a = pictures.arguments;
  const bool is_sequence = !a.path.empty();
  const std::size_t count = cameras.size();
  // Refuses names before anything is drawn.
  const Output* const of_pictures[] = {&a.color, &a.depth};
  const Output* const of_run[] = {&a.stats};
  if (is_sequence) check_numbered(of_pictures, of_run, count);
  OutputFiles files;
  std::unique_ptr<Mp4Writer> video;
  if (a.color.is_film())
    video = std::make_unique<Mp4Writer>(files.begin(a.color), a.options.width, a.options.height,
                                        a.pictures_a_second());

  std::vector<TerrainStats> frames;
  const int repeats = a.frames.value_or(1);
  for (std::size_t i = 0; i < count; ++i) {
    for (int n = 0; n < repeats; ++n) {
      progress.show(is_sequence
                        ? "picture " + std::to_string(i + 1) + " of " + std::to_string(count)
                        : "rendering frame " + std::to_string(n + 1) + " of " +
                              std::to_string(repeats));
      frames.push_back(pictures.draw(cameras[i]));
    }
    pictures.annotate(frames.back().camera);
    OutputFiles of_picture;  // in a sequence, visible as soon as it is drawn
    OutputFiles& to = is_sequence ? of_picture : files;
    const auto named = [&](const Output& output) {
      return is_sequence ? numbered(output, i, count) : output;
    };
    if (video)
      video->add(pictures.color.view());
    else if (a.color)
      io::write_png(to.begin(named(a.color)), pictures.color.view());
    if (a.depth) pictures.write_depth(cameras[i], named(a.depth), to);
    progress.clear();
    pictures.print_hashes(is_sequence ? std::optional(i) : std::nullopt);
    of_picture.commit();
  }
  if (video) video->finish();
  progress.clear();
  const double fastest = std::ranges::min(frames, {}, &TerrainStats::frame_ms).frame_ms;
  if (a.stats) write_json(files.begin(a.stats), terrain_stats(pictures, std::move(frames)));
  files.commit();
  if (a.quiet || !a.color) return;
  if (is_sequence)
    std::fprintf(stderr, "%s: %lu pictures of %dx%d\n", a.color.name().c_str(),
                 static_cast<unsigned long>(count), a.options.width, a.options.height);
  else
    std::fprintf(stderr, "%s: %dx%d, map %dx%d, %.1f ms%s\n", a.color.name().c_str(),
                 a.options.width, a.options.height, pictures.source.width(),
                 pictures.source.height(), fastest, repeats > 1 ? " the fastest frame" : "");
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
  if (const std::string missing = missing_glyphs(a.words); !a.quiet && !missing.empty())
    warn(missing);
  const double load_ms = timeline.now_ms();
  progress.show("lighting");
  const terrain::TerrainCamera camera = camera_of(a, source);
  // Far ground in fog takes the colour behind it.
  if (frame.environment_behind) a.options.sky = horizon_color(frame.lights, frame.tone, camera);
  LitGround ground(source, a.options, a.light, frame, camera);
  if (objects) {
    objects->place(ground.terrain());
    if (!a.quiet && !objects->warnings().empty()) {
      progress.clear();
      for (const std::string& w : objects->warnings()) warn(w);
    }
  }
  TerrainPictures pictures{a,
                           source,
                           ground,
                           renderer,
                           objects ? &*objects : nullptr,
                           load_ms,
                           timeline.now_ms() - load_ms};
  write_pictures(pictures, cameras_of(a, camera), progress);
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
  add_path_options(command.under("Camera path"), *arguments,
                   "pictures a second of the path (default: 30)");
  add_terrain_picture(command, *arguments);
  add_terrain_light(command, *arguments);
  add_ground_lights(command, arguments->frame(), arguments->objects.scene.lights);
  add_terrain_objects(command, arguments->objects);
  add_ground_options(command, arguments->ground);
  add_word_options(command.under("Words"), arguments->words);
  add_terrain_machine(command, *arguments);
  add_frames_option(command.under("Machine"), *arguments);
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
      "--bounds -o map.png\n"
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
