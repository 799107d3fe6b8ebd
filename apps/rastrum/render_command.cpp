// `rastrum render INPUT… -o OUT`: the options, then check, load, render, write.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/camera.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "annotations.hpp"
#include "arguments.hpp"
#include "camera_path.hpp"
#include "commands.hpp"
#include "frame_images.hpp"
#include "heatmap.hpp"
#include "inputs.hpp"
#include "json_fields.hpp"
#include "json_file.hpp"
#include "light_options.hpp"
#include "mp4.hpp"
#include "nothing_seen.hpp"
#include "numbered.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "render_arguments.hpp"
#include "render_job.hpp"
#include "render_out_of_core.hpp"
#include "render_outputs.hpp"
#include "render_ranks.hpp"
#include "scene_options.hpp"
#include "sequence.hpp"
#include "stats_json.hpp"
#include "timeline.hpp"
#include "transparency.hpp"
#include "view.hpp"

namespace rastrum::cli {
namespace {

void add_output_options(Parser& app, RenderArguments& a) {
  const char* group = "Outputs";
  add(app, "-o,--output", "FILE",
      ".png: 8 bit, straight alpha; .exr, .npy: float32, premultiplied; with --path or --turntable "
      "also .mp4, over black; - is standard output, here and below",
      [&a](const std::string& s) { a.color_file = s; })
      ->group(group);
  add(app, "--output-format", "NAME", "png, exr, npy: of -o, where its name does not say (png)",
      [&a](const std::string& s) {
        a.color_format =
            choose<Format>("--output-format", s,
                           {{"png", Format::png}, {"exr", Format::exr}, {"npy", Format::npy}});
      })
      ->group(group);
  add(app, "--depth", "FILE", ".npy or .exr: float32, 1 near, 0 far and where nothing is",
      [&a](const std::string& s) {
        a.depth = parse_output("--depth", s, {Format::npy, Format::exr});
      })
      ->group(group);
  add(app, "--depth-unit", "NAME",
      "of --depth: reversed, or world: the distance along the view axis in the scene's units, inf "
      "where nothing is (reversed)",
      [&a](const std::string& s) {
        a.depth_unit = choose<DepthUnit>(
            "--depth-unit", s, {{"world", DepthUnit::world}, {"reversed", DepthUnit::reversed}});
      })
      ->group(group);
  add(app, "--ids", "FILE", ".npy: int64, triangle in order of submission, -1 where nothing is",
      [&a](const std::string& s) { a.ids = parse_output("--ids", s, {Format::npy}); })
      ->group(group);
  add(app, "--objects", "FILE",
      ".npy: int32, which INPUT is seen, from 0 in command order, -1 where nothing is",
      [&a](const std::string& s) { a.objects = parse_output("--objects", s, {Format::npy}); })
      ->group(group);
  app.add_repeated("--image", "NAME=FILE",
                   "what is seen at each pixel (docs/conventions.md), .npy, or .exr where it is of "
                   "one, three or four floats; may be repeated; the names: " +
                       frame_image_names(),
                   [&a](const std::string& s) { a.images.push_back(parse_frame_image(s)); })
      ->group(group);
  add(app, "--heatmap", "FILE",
      ".png: fragments at each pixel, hidden ones too, as colours; legend on stderr",
      [&a](const std::string& s) { a.heatmap = parse_output("--heatmap", s, {Format::png}); })
      ->group(group);
  add(app, "--show-errors", "FILE",
      ".png: the picture in grey, and red where filter:K blended in a wrong order, or exact had to "
      "sort a pixel that its filter could not hold",
      [&a](const std::string& s) { a.errors = parse_output("--show-errors", s, {Format::png}); })
      ->group(group);
  add(app, "--stats", "FILE", ".json: counts, memory, times, ids of the inputs, cameras",
      [&a](const std::string& s) { a.stats = parse_output("--stats", s, {Format::json}); })
      ->group(group);
  add(app, "--trace", "FILE", ".json: stages for chrome://tracing or ui.perfetto.dev",
      [&a](const std::string& s) { a.trace = parse_output("--trace", s, {Format::json}); })
      ->group(group);
  app.add_flag("--hash", a.hash,
               "print the digest (SHA-256, docs/conventions.md) of the pixels of each picture that "
               "is written, or without any of the 8-bit colours")
      ->group(group);
  app.add_flag("--quiet", a.quiet, "print errors alone: no warnings, legend, summary or progress")
      ->group(group);
}

void add_path_options(Parser& app, RenderArguments& a) {
  const char* group = "Many pictures";
  add(app, "--turntable", "N",
      "N pictures of a full turn about the camera's target: -o 'turn_%03d.png' or, through ffmpeg, "
      "-o turn.mp4",
      [&a](const std::string& s) { a.turntable = parse_integer("--turntable", s, 1, 1000000); })
      ->group(group);
  add(app, "--path", "FILE",
      "draw a picture for each moment of a camera path (docs/window.md): -o 'frame_%04d.png' or, "
      "through ffmpeg, -o flight.mp4",
      [&a](const std::string& s) { a.path = s; })
      ->group(group);
  add(app, "--fps", "N", "pictures a second of the path or the film (30)",
      [&a](const std::string& s) {
        a.fps = parse_number("--fps", s);
        a.fps_given = true;
        if (!(a.fps > 0 && a.fps <= 1000)) throw UsageError("--fps", "must lie in 0 to 1000");
      })
      ->group(group);
}

void add_motion_options(Parser& app, RenderArguments& a) {
  const char* group = "Motion";
  add(app, "--time", "S",
      "the moment of an animation of the files, in seconds; what has ended begins again (without: "
      "as "
      "the files stand, and along --path each picture's own time)",
      [&a](const std::string& s) {
        a.time_s = parse_number("--time", s);
        if (!(*a.time_s >= 0)) throw UsageError("--time", "must not be negative, got '" + s + "'");
      })
      ->group(group);
  add(app, "--animation", "N", "which one, as `rastrum info` counts them (0)",
      [&a](const std::string& s) { a.animation = parse_integer("--animation", s, 0, 1000000); })
      ->group(group);
}

void add_ranks_options(Parser& app, RenderArguments& a) {
  add(app, "--timeout", "S",
      "with mpirun: end the job where a rank waits longer than this for the others, and say in "
      "what "
      "(for ever)",
      [&a](const std::string& s) {
        a.timeout_s = parse_number("--timeout", s);
        a.timeout_given = true;
        if (!(a.timeout_s > 0)) throw UsageError("--timeout", "must be greater than 0");
      })
      ->group(kMachineGroup);
}

void add_out_of_core_option(Parser& app, RenderArguments& a) {
  add(app, "--out-of-core", "NAME",
      "draw a binary .ply, .stl, .glb or .npy chunk by chunk without reading it into memory, all "
      "within "
      "--memory-limit (docs/scale.md); auto: one INPUT that takes more than a limit of 64M or "
      "more; always (2G without a limit), never (auto)",
      [&a](const std::string& s) {
        a.out_of_core = choose<OutOfCore>("--out-of-core", s,
                                          {{"auto", OutOfCore::automatic},
                                           {"always", OutOfCore::always},
                                           {"never", OutOfCore::never}});
      })
      ->group(kMachineGroup);
}

void add_frames_option(Parser& app, RenderArguments& a) {
  add(app, "--frames", "N", "render N times; --stats gives median, minimum and maximum (1)",
      [&a](const std::string& s) {
        a.frames = parse_integer("--frames", s, 1, 1000000);
        a.frames_given = true;
      })
      ->group(kMachineGroup);
  app.add_flag(
         "--prepare", a.prepares,
         "sort the meshes' triangles into clusters first, which pictures leave out where they "
         "are not seen: for --frames, --turntable and --path of some ten pictures or more")
      ->group(kMachineGroup);
}

void check_sequence(RenderArguments& a) {
  const char* option = a.path.empty() ? "--turntable" : "--path";
  if (a.frames_given)
    throw UsageError("--frames", std::string("leaves no room for ") + option +
                                     ": both say how many frames are drawn");
  if (!a.path.empty() && a.turntable != 0)
    throw UsageError("--turntable", "leaves no room for --path: both move the camera");
  if (a.turntable != 0 && a.view.file_camera)
    throw UsageError("--turntable",
                     "the camera of a file has no target to turn about: give --eye and --target");
  for (const Output* output : picture_outputs(a))
    if (output->format == Format::mp4)
      Mp4Writer::check(a.render.width, a.render.height);
    else
      static_cast<void>(NumberedName(output->option, output->file.string()));
  if (!a.path.empty())
    static_cast<void>(read_json(a.path));  // a spoilt file is refused before a large scene is read
}

/// Whether numbers are asked for beside colours, which are compared with others.
bool asks_for_numbers(const RenderArguments& a) {
  return a.depth || a.ids || a.objects || !a.images.empty() || a.heatmap || a.errors;
}

/// Checks what the parser cannot see by itself, before anything is read.
void check(RenderArguments& a) {
  if (a.color_file)
    a.color = parse_output("-o", *a.color_file,
                           {Format::png, Format::exr, Format::npy, Format::mp4}, a.color_format);
  else if (a.color_format)
    throw UsageError("--output-format", "is for -o");
  if (!a.color && !a.depth && !a.ids && !a.objects && a.images.empty() && !a.heatmap && !a.errors &&
      !a.stats && !a.trace && !a.hash)
    throw UsageError("-o", "say where the picture goes, as in -o picture.png");
  set_look(a, is_to_be_shown(a) && !asks_for_numbers(a), a.path.empty(),
           a.color || a.errors || a.hash);
  check_scene_arguments(a);
  check_annotations(a.annotations, a.color || a.errors || a.hash);
  if (a.depth_unit && !a.depth) throw UsageError("--depth-unit", "is for --depth");
  if (a.animation && !a.time_s && a.path.empty())
    throw UsageError("--animation", "is for --time and --path");
  if (!a.is_sequence() && a.fps_given) throw UsageError("--fps", "is for --path and --turntable");
  if (!a.is_sequence() && a.color && a.color.format == Format::mp4)
    throw UsageError("-o",
                     "an .mp4 is drawn along a camera path or of a full turn: give --path or "
                     "--turntable");
  if (a.is_sequence()) check_sequence(a);
}

/// Throws where outputs cannot be written. Called again once the inputs have told which files they
/// name.
void check_files(RenderArguments& a) {
  remember_inputs(a.inputs);
  std::vector<const Output*> outputs;
  for (const Output* const output : picture_outputs(a)) outputs.push_back(output);
  outputs.insert(outputs.end(), {&a.trace, &a.stats});
  check_outputs(outputs);
  if (a.hash) check_hash(outputs);
}

void report_blended(const Scene& scene) {
  const auto blended = std::ranges::count(scene.materials, AlphaMode::blend, &Material::alpha_mode);
  if (blended != 0)
    warn(std::to_string(blended) + " of " + std::to_string(scene.materials.size()) +
         " materials ask for blending (alphaMode BLEND) and are drawn opaque, as --transparency "
         "none "
         "says");
}

void report_missing(const FrameStats& frame) {
  if (frame.triangles.dropped != 0)
    warn(std::to_string(frame.triangles.dropped) + " of " + std::to_string(frame.triangles.input) +
         " triangles have a NaN or infinite vertex and are not drawn");
}

/// `a` with the names of picture `number`.
RenderArguments with_numbers(RenderArguments a, std::size_t number, std::size_t count) {
  for (Output* output : picture_outputs(a)) *output = numbered(std::move(*output), number, count);
  return a;
}

/// The JSON of --stats: the frames, what was drawn and from where, a camera for each picture.
nlohmann::ordered_json describe(const std::vector<FrameStats>& frames, const RenderArguments& a,
                                double load_ms, const Inputs& inputs,
                                const std::vector<Camera>& cameras) {
  nlohmann::ordered_json stats = stats_json(frames, a.render, load_ms);
  nlohmann::ordered_json& parts = stats["inputs"] = nlohmann::ordered_json::array();
  for (const InputPart& part : inputs.parts)
    parts.push_back(
        {{"name", part.name}, {"first_id", part.first_id}, {"triangles", part.triangles}});
  nlohmann::ordered_json& list = stats["cameras"] = nlohmann::ordered_json::array();
  for (const Camera& camera : cameras) list.push_back(camera_json(camera, true));
  return stats;
}

/// The outputs that are of the whole run; then all of `files` can be seen.
void finish(const RenderArguments& a, const std::vector<FrameStats>& frames, double load_ms,
            const Inputs& inputs, const std::vector<Camera>& cameras, const Timeline& timeline,
            OutputFiles& files) {
  if (a.stats) write_json(files.begin(a.stats), describe(frames, a, load_ms, inputs, cameras));
  if (a.trace) write_trace(files.begin(a.trace), timeline);
  files.commit();
}

int run_sequence(RenderArguments& a, Renderer& renderer, const Sequence& sequence,
                 const Inputs& inputs, double load_ms, Timeline& timeline, Progress& progress) {
  const std::vector<Output*> mutable_outputs = picture_outputs(a);
  const std::vector<const Output*> of_pictures(mutable_outputs.begin(), mutable_outputs.end());
  const Output* const of_run[] = {&a.stats, &a.trace};
  check_numbered(of_pictures, of_run, sequence.count);
  OutputFiles of_the_run;  // each picture's own files are seen as soon as it is drawn
  std::unique_ptr<Mp4Writer> video;
  if (a.color && a.color.format == Format::mp4)
    video = std::make_unique<Mp4Writer>(of_the_run.begin(a.color), a.render.width, a.render.height,
                                        a.fps);

  Pictures pictures;
  std::vector<FrameStats> frames;
  std::vector<Camera> cameras;
  const Annotations notes = meant(a.annotations);
  Annotator annotator(a.render.threads, a.render.isa);
  std::size_t empty = 0, first_empty = 0;
  for (std::size_t i = 0; i < sequence.count; ++i) {
    progress.show("picture " + std::to_string(i + 1) + " of " + std::to_string(sequence.count));
    const auto [scene, camera] = sequence.shot(i);
    const auto stats =
        render_frames(renderer, scene, camera, a.render, wanted_of(a, &notes, &annotator), false, 1,
                      pictures, timeline, progress);
    frames.push_back(stats.front());
    cameras.push_back(camera);
    if (is_empty(stats.front(), a.render) && empty++ == 0) first_empty = i;
    annotate_pictures(a, notes, pictures, scene, camera, annotator);
    OutputFiles files;
    write_images(with_numbers(a, i, sequence.count), pictures, camera, inputs, i, files, timeline,
                 progress);
    files.commit();
    if (video) video->add(pictures.color8.view());
  }
  if (video) video->finish();
  progress.clear();
  const FrameStats& median = frames[median_frame(frames)];
  if (!a.quiet) {
    report_missing(median);
    if (empty != 0) {
      const auto [scene, camera] = sequence.shot(first_empty);
      warn("nothing is seen in " + std::to_string(empty) + " of " + std::to_string(sequence.count) +
           " pictures; in number " + std::to_string(first_empty) + ", the first of them, " +
           why_empty(frames[first_empty], a.render, scene, camera).reason);
    }
  }
  finish(a, frames, load_ms, inputs, cameras, timeline, of_the_run);
  if (!a.quiet && a.color)
    std::fprintf(stderr, "%s: %lu pictures of %dx%d, %lu triangles, %.1f ms a picture\n",
                 a.color.name().c_str(), static_cast<unsigned long>(sequence.count), a.render.width,
                 a.render.height, static_cast<unsigned long>(median.triangles.input),
                 median.frame_ms);
  return 0;
}

/// Poses the inputs for --time. Whether they move along the path, too.
bool pose_for(const RenderArguments& a, Inputs& inputs) {
  if (!a.time_s && a.path.empty()) return false;
  const std::size_t count = animation_count(inputs.scene);
  const auto animation = static_cast<std::size_t>(a.animation.value_or(0));
  if (a.animation && animation >= count)
    throw UsageError("--animation", "there is no animation " + std::to_string(animation) +
                                        ": the files have " + std::to_string(count));
  if (count == 0) {
    if (a.time_s && !a.quiet) warn("--time: no input has an animation");
    return false;
  }
  if (a.time_s) pose_inputs(inputs, a.normals, *a.time_s, animation);
  return !a.time_s;
}

int run(RenderArguments& a, const StartRanks& start) {
  check(a);
  if (start) {
    if (const std::unique_ptr<RanksOfProgram> ranks = start(a.timeout_s))
      return render_with_ranks(a, *ranks, [&a] { check_files(a); });
  }
  if (a.timeout_given)
    throw UsageError("--timeout", "is of several ranks, as in mpirun -n 8 rastrum render");
  check_files(a);
  Timeline timeline;
  Progress progress(a.quiet);
  if (const std::optional<OutOfCoreFile> large = large_input(a))
    return render_out_of_core(a, *large, timeline, progress);
  // Refuses what this machine or build cannot do before a large file is read.
  rastrum::check(a.render);
  Renderer renderer = family::make_renderer(a.render, a.render);

  const double load_begin = timeline.now_ms();
  Inputs inputs = load_inputs(a.inputs, a.normals, timeline, progress, a.reading);
  check_files(a);
  set_sizes(inputs.scene, a.sizes);
  const Scene& scene = inputs.scene;
  const double load_ms = timeline.now_ms() - load_begin;
  if (!a.quiet && !scene.warnings.empty()) {
    progress.clear();
    for (const std::string& w : scene.warnings) warn(w);
  }
  if (!a.quiet && a.render.transparency.method == Transparency::none) report_blended(scene);
  if (!a.quiet) report_missing_glyphs(a.annotations.words, a.annotations.scalars.words());
  const std::vector<Light> said = a.render.lights;
  const auto light_by_files = [&] {
    if (!a.lights.of_files) return;
    a.render.lights = said;
    add_file_lights(scene, a.render.lights);
  };
  const bool moves = pose_for(a, inputs);
  light_by_files();
  set_scalars(a.annotations.scalars, inputs.scene);
  SceneBinding binding(scene);
  if (a.prepares) {
    if (moves)
      throw UsageError("--prepare",
                       "is of meshes that stay as they are; this file moves along --path");
    timeline.measure("prepare", "prepare", [&] { binding.prepare(a.render.threads); });
  }
  a.render.shader = shader_of(a.render.shader, inputs.has_materials);
  a.view.turns = a.turntable != 0;
  Camera camera = choose_camera(a.view, scene, binding.view(), {a.render.width, a.render.height});
  if (!a.view.file_camera && !a.view.eye && !a.view.orthographic_height)
    camera =
        with_room(meant(a.annotations), camera, binding.view(), a.render.width, a.render.height);

  std::optional<SceneBinding> posed;
  SceneAt moving;
  if (moves)
    moving = [&](double seconds) {
      pose_inputs(inputs, a.normals, seconds, static_cast<std::size_t>(a.animation.value_or(0)));
      light_by_files();
      return posed.emplace(scene).view();
    };
  if (a.is_sequence())
    return run_sequence(a, renderer,
                        a.turntable != 0
                            ? on_turntable(a.turntable, binding.view(), a.view, camera)
                            : along_path(a.path, a.fps, binding.view(), moving, a.view, camera),
                        inputs, load_ms, timeline, progress);
  const bool timed = a.frames_given || a.stats || a.trace;
  const Annotations notes = meant(a.annotations);
  Annotator annotator(a.render.threads, a.render.isa);
  Pictures pictures;
  const std::vector<FrameStats> frames =
      render_frames(renderer, binding.view(), camera, a.render, wanted_of(a, &notes, &annotator),
                    timed, a.frames, pictures, timeline, progress);
  const FrameStats& median = frames[median_frame(frames)];
  progress.clear();
  if (!a.quiet) {
    report_missing(median);
    if (is_empty(median, a.render)) {
      const Emptiness why = why_empty(median, a.render, binding.view(), camera);
      warn("nothing is seen: " + why.reason + "; " + why.remedy);
    }
  }

  timeline.measure("words and effects", "annotate", [&] {
    annotate_pictures(a, notes, pictures, binding.view(), camera, annotator);
  });
  OutputFiles files;
  write_images(a, pictures, camera, inputs, {}, files, timeline, progress);
  progress.clear();
  finish(a, frames, load_ms, inputs, {camera}, timeline, files);
  if (!a.quiet && a.color)
    std::fprintf(stderr, "%s: %dx%d, %lu triangles, %.1f ms%s\n", a.color.name().c_str(),
                 a.render.width, a.render.height,
                 static_cast<unsigned long>(median.triangles.input), median.frame_ms,
                 timed ? " a frame" : "");
  return 0;
}

}  // namespace

Command add_render_command(Parser& app, StartRanks start) {
  auto arguments = std::make_shared<RenderArguments>();
  Parser render = app.add_subcommand("render", "Draw meshes and shapes into an image file");
  add_input_option(render, *arguments)->required();
  add_output_options(render, *arguments);
  add_picture_options(render, *arguments);
  add_look_option(render, *arguments);
  add_transparency_options(render, *arguments);
  add_annotation_options(render, arguments->annotations);
  add_camera_options(render, *arguments);
  add_path_options(render, *arguments);
  add_motion_options(render, *arguments);
  add_machine_options(render, *arguments);
  add_frames_option(render, *arguments);
  add_out_of_core_option(render, *arguments);
  add_ranks_options(render, *arguments);
  std::string footer = shapes_help();
  footer +=
      "\nTimes: a frame goes from the mesh in memory to the finished 8-bit image in memory. With\n"
      "--frames, --stats or --trace the timed frames fill that image alone, and one more pass,\n"
      "which is not timed, fills the others; without them one pass fills all.\n"
      "\nExamples:\n"
      "  rastrum render bunny.obj -o bunny.png\n"
      "  rastrum render scene.glb --camera 0 --size 1920x1080 --background '#20242c' -o scene.png\n"
      "  rastrum render a.stl b.ply --eye 3,2,5 --target 0,0,0 --depth d.npy --ids i.npy -o c.exr\n"
      "  rastrum render builtin:teapot 'builtin:sphere?x=3,scale=0.5' --shader normal -o two.png\n"
      "  rastrum render part.stl -o part.png\n"
      "  rastrum render part.stl --lights studio --light point:0,2,1:intensity=3 -o lit.png\n"
      "  rastrum render scan.ply --scalars quality --cmap turbo --bar Quality -o quality.png\n"
      "  rastrum render part.stl --bounds --axes --occlusion --title 'Part 7' -o part.png\n"
      "  rastrum render engine.glb --opacity 0.3 --samples 4 -o see_through.png\n"
      "  rastrum render hair.ply --opacity 0.5 --transparency filter:3 --show-errors wrong.png\n"
      "  rastrum render dragon.ply --frames 20 --stats - --trace frames.json --heatmap heat.png\n"
      "  rastrum render fox.glb --animation 1 --time 0.4 -o running.png\n"
      "  rastrum render dragon.ply --path flight.json --fps 60 -o 'frame_%04d.png'\n"
      "  rastrum render shell.ply@opacity=0.3,color=#88aaff core.stl@z=0.2,rx=90 -o glass.png\n"
      "  rastrum render dragon.ply --turntable 120 -o dragon.mp4\n"
      "  rastrum render scan.ply --memory-limit 2G -o scan.png\n"
      "  mpirun -n 8 rastrum render part_*.ply -o all.png\n"
      "  rastrum render a.stl b.stl --depth d.npy --depth-unit world --objects o.npy\n"
      "  rastrum make sphere -o - | rastrum render - --format ply -o - | display";
  render.footer(footer);
  return {render, [arguments, start = std::move(start)] { return run(*arguments, start); }};
}

}  // namespace rastrum::cli
