// `rastrum render INPUT… -o OUT`: the options, then check, load, render, write.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/io/io.hpp>
#include <rastrum/render/render.hpp>
#include <rastrum/scene/shapes/shapes.hpp>

#include "arguments.hpp"
#include "commands.hpp"
#include "heatmap.hpp"
#include "inputs.hpp"
#include "json_file.hpp"
#include "option.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "render_job.hpp"
#include "stats_json.hpp"
#include "timeline.hpp"
#include "transparency.hpp"
#include "view.hpp"

namespace rastrum::cli {
namespace {

struct RenderArguments {
  std::vector<std::string> inputs;
  RenderOptions render;
  bool shader_given = false;
  Normals normals = Normals::file;
  ViewOptions view;
  bool fit = false;
  bool frames_given = false;
  int frames = 1;
  bool quiet = false;
  Output color, depth, ids, heatmap, errors, trace, stats;
};

std::string names_of(const std::vector<AxisInfo>& axis) {
  std::string names = "auto";
  for (const AxisInfo& info : axis) names.append(", ").append(info.name);
  return names;
}

std::string check_axis(const char* option, const std::vector<AxisInfo>& axis,
                       const std::string& text) {
  if (text == "auto") return text;
  for (const AxisInfo& info : axis)
    if (text == info.name) return text;
  throw UsageError(option, "expected one of " + names_of(axis) + ", got '" + text + "'");
}

Shader parse_shader(const std::string& text) {
  try {
    return shader_from_name(text);
  } catch (const Error& e) {
    throw UsageError("--shader", e.what());
  }
}

void add_output_options(CLI::App& app, RenderArguments& a) {
  const char* group = "Outputs";
  add(app, "-o,--output", "FILE", ".png: 8 bit, straight alpha; .exr, .npy: float32, premultiplied",
      [&a](const std::string& s) {
        a.color = parse_output("-o", s, {Format::png, Format::exr, Format::npy});
      })
      ->group(group);
  add(app, "--depth", "FILE", ".npy or .exr: float32, 1 near, 0 far and where nothing is",
      [&a](const std::string& s) {
        a.depth = parse_output("--depth", s, {Format::npy, Format::exr});
      })
      ->group(group);
  add(app, "--ids", "FILE", ".npy: int64, triangle in order of submission, -1 where nothing is",
      [&a](const std::string& s) { a.ids = parse_output("--ids", s, {Format::npy}); })
      ->group(group);
  add(app, "--heatmap", "FILE", ".png: fragments at each pixel as colours; legend on stderr",
      [&a](const std::string& s) { a.heatmap = parse_output("--heatmap", s, {Format::png}); })
      ->group(group);
  add(app, "--show-errors", "FILE",
      ".png: the picture in grey, and red where filter:K blended in a wrong order, or exact had to "
      "sort a pixel that its filter could not hold",
      [&a](const std::string& s) { a.errors = parse_output("--show-errors", s, {Format::png}); })
      ->group(group);
  add(app, "--stats", "FILE", ".json or - (standard output): counts, memory and times",
      [&a](const std::string& s) {
        a.stats = s == "-" ? Output{"--stats", s, Format::json}
                           : parse_output("--stats", s, {Format::json});
      })
      ->group(group);
  add(app, "--trace", "FILE", ".json: stages for chrome://tracing or ui.perfetto.dev",
      [&a](const std::string& s) { a.trace = parse_output("--trace", s, {Format::json}); })
      ->group(group);
  app.add_flag("--quiet", a.quiet, "print errors alone: no warnings, legend, summary or progress")
      ->group(group);
}

void add_picture_options(CLI::App& app, RenderArguments& a) {
  const char* group = "Picture";
  add(app, "--size", "WxH", "pixels, up to 32768x32768 (1280x720)", [&a](const std::string& s) {
    const Size size = parse_size("--size", s);
    a.render.width = size.width;
    a.render.height = size.height;
  })->group(group);
  std::string shaders;
  for (const std::string_view shader : shader_names())
    shaders.append(shaders.empty() ? "" : ", ").append(shader);
  add(app, "--shader", "NAME", shaders + " (material where a file has materials, else phong)",
      [&a](const std::string& s) {
        a.render.shader = parse_shader(s);
        a.shader_given = true;
      })
      ->group(group);
  add(app, "--normals", "NAME",
      "file: the file's, else vertex; vertex: area-weighted means; face (file)",
      [&a](const std::string& s) {
        a.normals = choose<Normals>(
            "--normals", s,
            {{"file", Normals::file}, {"vertex", Normals::vertex}, {"face", Normals::face}});
      })
      ->group(group);
  add(app, "--cull", "NAME",
      "none, back, front; counter-clockwise is front; with none, the material shader still leaves "
      "out the back of single-sided glTF materials (none)",
      [&a](const std::string& s) {
        a.render.cull = choose<Cull>(
            "--cull", s, {{"none", Cull::none}, {"back", Cull::back}, {"front", Cull::front}});
      })
      ->group(group);
  add(app, "--background", "#RRGGBB[AA]", "(#00000000, transparent)", [&a](const std::string& s) {
    a.render.background = parse_color("--background", s);
  })->group(group);
}

void add_transparency_options(CLI::App& app, RenderArguments& a) {
  const char* group = "Transparency and samples";
  add(app, "--opacity", "A",
      "of every surface, 0 to 1: opaque and masked materials get alpha A, what blends alpha * A "
      "(1)",
      [&a](const std::string& s) {
        const double opacity = parse_number("--opacity", s);
        if (!(opacity >= 0 && opacity <= 1))
          throw UsageError("--opacity", "must lie in 0 to 1, got '" + s + "'");
        a.render.opacity = static_cast<float>(opacity);
      })
      ->group(group);
  add(app, "--transparency", "NAME",
      transparency_words() +
          "; filter:K orders by blocks and K fragments a pixel, without repair; none draws what is "
          "translucent opaque (exact)",
      [&a](const std::string& s) { parse_transparency(s, a.render.transparency); })
      ->group(group);
  add(app, "--alpha-threshold", "[A]",
      "leaves out what lies behind pixels that have this alpha; alone: 1 - 1/128 (1: nothing)",
      [&a](const std::string& s) {
        a.render.transparency.alpha_threshold = parse_alpha_threshold(s);
      })
      ->expected(0, 1)
      ->group(group);
  add(app, "--samples", "N",
      "1, 4, 8 or 16 a pixel, at D3D11's standard positions; --ids and --depth are of the nearest "
      "one (1)",
      [&a](const std::string& s) {
        a.render.samples = choose<int>("--samples", s, {{"1", 1}, {"4", 4}, {"8", 8}, {"16", 16}});
      })
      ->group(group);
}

void add_camera_options(CLI::App& app, RenderArguments& a) {
  const char* group = "Camera (what is not given is taken from --fit)";
  ViewOptions& v = a.view;
  app.add_flag("--fit", a.fit, "look along -z at all that is there (the default)")->group(group);
  add(app, "--camera", "N", "the N-th camera of the files, from 0", [&v](const std::string& s) {
    v.file_camera = parse_integer("--camera", s, 0, std::numeric_limits<int>::max());
  })->group(group);
  add(app, "--eye", "X,Y,Z", "where the camera stands", [&v](const std::string& s) {
    v.eye = parse_vec3("--eye", s);
  })->group(group);
  add(app, "--target", "X,Y,Z", "what it looks at", [&v](const std::string& s) {
    v.target = parse_vec3("--target", s);
  })->group(group);
  add(app, "--up", "X,Y,Z", "which way is up in the picture (0,1,0)", [&v](const std::string& s) {
    v.up = parse_vec3("--up", s);
  })->group(group);
  add(app, "--fov", "DEG", "field of view across the smaller side (60)",
      [&v](const std::string& s) { v.fov_deg = parse_number("--fov", s); })
      ->group(group);
  add(app, "--near", "N", "distance of the near plane (just before the scene)",
      [&v](const std::string& s) { v.near_plane = parse_number("--near", s); })
      ->group(group);
  add(app, "--far", "F|inf", "distance of the far plane (inf; orthographic: behind the scene)",
      [&v](const std::string& s) {
        v.far_plane =
            s == "inf" ? std::numeric_limits<double>::infinity() : parse_number("--far", s);
      })
      ->group(group);
  add(app, "--orthographic", "HEIGHT|fit",
      "parallel projection, HEIGHT world units across the smaller side",
      [&v](const std::string& s) {
        v.orthographic = true;
        if (s != "fit") v.orthographic_height = parse_number("--orthographic", s);
      })
      ->group(group);
}

void add_machine_options(CLI::App& app, RenderArguments& a) {
  const char* group = "Machine";
  add(app, "--rasterizer", "NAME", names_of(rasterizers()) + " (auto)", [&a](const std::string& s) {
    a.render.rasterizer = check_axis("--rasterizer", rasterizers(), s);
  })->group(group);
  add(app, "--visibility", "NAME", names_of(visibilities()) + " (auto)",
      [&a](const std::string& s) {
        a.render.visibility = check_axis("--visibility", visibilities(), s);
      })
      ->group(group);
  add(app, "--device", "NAME", "serial, threads, cuda (threads)", [&a](const std::string& s) {
    a.render.device = parse_device(s);
  })->group(group);
  add(app, "--threads", "N", "(all)", [&a](const std::string& s) {
    a.render.threads = parse_integer("--threads", s, 1, 4096);
  })->group(group);
  add(app, "--memory-limit", "BYTES",
      "scratch beyond the mesh and the images, with K, M or G; what does not fit at once is drawn "
      "piece by piece (none)",
      [&a](const std::string& s) { a.render.memory_limit = parse_bytes("--memory-limit", s); })
      ->group(group);
  add(app, "--isa", "NAME", "instruction set; this machine has " + isa_words() + " (the last)",
      [&a](const std::string& s) { a.render.isa = parse_isa(s); })
      ->group(group);
  add(app, "--frames", "N", "render N times; --stats gives median, minimum and maximum (1)",
      [&a](const std::string& s) {
        a.frames = parse_integer("--frames", s, 1, 1000000);
        a.frames_given = true;
      })
      ->group(group);
}

/// What the parser cannot see by itself, before anything is read.
void check(const RenderArguments& a) {
  if (!a.color && !a.depth && !a.ids && !a.heatmap && !a.errors && !a.stats && !a.trace)
    throw UsageError("-o", "say where the picture goes, as in -o picture.png");
  const ViewOptions& v = a.view;
  if (a.fit && (v.eye || v.target || v.file_camera))
    throw UsageError("--fit", "leaves no room for --eye, --target or --camera");
  if (v.file_camera && v.orthographic)
    throw UsageError("--orthographic", "the camera of a file has a projection of its own");
  check_view(v);
  const bool stats_to_file = a.stats && a.stats.file != "-";
  const Output none;
  const Output* const outputs[] = {&a.color,
                                   &a.depth,
                                   &a.ids,
                                   &a.heatmap,
                                   &a.errors,
                                   &a.trace,
                                   stats_to_file ? &a.stats : &none};
  check_outputs(outputs);
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
  if (frame.triangles.input == 0) warn("there are no triangles to draw");
  if (frame.triangles.dropped != 0)
    warn(std::to_string(frame.triangles.dropped) + " of " + std::to_string(frame.triangles.input) +
         " triangles have a NaN or infinite vertex and are not drawn");
}

void write_error_picture(const RenderArguments& a, const Pictures& p, Progress& progress) {
  const ErrorPicture picture = make_error_picture(p.color8.view(), p.errors.view());
  io::write_png(a.errors.file, picture.image.view());
  progress.clear();
  if (a.quiet) return;
  const bool repaired = a.render.transparency.method == Transparency::exact;
  std::fprintf(stderr, "%s: %lu of %lu pixels are red: %s\n", a.errors.file.c_str(),
               static_cast<unsigned long>(picture.wrong),
               static_cast<unsigned long>(p.errors.pixels().size()),
               repaired ? "the filter could not hold them, and they were sorted"
                        : "blended in a wrong order");
}

void write_images(const RenderArguments& a, const Pictures& p, Timeline& timeline,
                  Progress& progress) {
  const auto write = [&](const Output& output, auto&& writer) {
    if (!output) return;
    progress.show("writing " + output.file.string());
    timeline.measure("write " + output.file.string(), "write", writer);
  };
  write(a.color, [&] { write_color(a.color, p.color8.view(), p.color.view()); });
  write(a.depth, [&] { write_depth(a.depth, p.depth.view()); });
  write(a.ids, [&] { io::write_npy(a.ids.file, p.ids.view()); });
  write(a.heatmap, [&] {
    const Heatmap heatmap = make_heatmap(p.overdraw.view());
    io::write_png(a.heatmap.file, heatmap.image.view());
    progress.clear();
    if (!a.quiet)
      std::fprintf(stderr,
                   "heatmap: black 0, dark violet 1, light yellow %lu fragments at a pixel, "
                   "logarithmic; %lu fragments in all\n",
                   static_cast<unsigned long>(heatmap.max),
                   static_cast<unsigned long>(heatmap.sum));
  });
  write(a.errors, [&] { write_error_picture(a, p, progress); });
}

int run(RenderArguments& a) {
  check(a);
  Timeline timeline;
  Progress progress(a.quiet);
  // Refuses what this machine or build cannot do before a large file is read.
  auto renderer = std::make_unique<Renderer>(a.render);

  const double load_begin = timeline.now_ms();
  const Scene scene = load_inputs(a.inputs, a.normals, timeline, progress);
  const double load_ms = timeline.now_ms() - load_begin;
  if (!a.quiet && !scene.warnings.empty()) {
    progress.clear();
    for (const std::string& w : scene.warnings) warn(w);
  }
  if (!a.shader_given && !scene.materials.empty()) {
    a.render.shader = Shader::material;
    renderer = std::make_unique<Renderer>(a.render);
  }
  if (!a.quiet && a.render.transparency.method == Transparency::none) report_blended(scene);
  const SceneBinding binding(scene);
  const Camera camera = choose_camera(a.view, scene, binding.view());

  const bool timed = a.frames_given || a.stats || a.trace;
  const Wanted wanted{.color8 = (a.color && a.color.format == Format::png) || a.errors,
                      .color = a.color && a.color.format != Format::png,
                      .depth = static_cast<bool>(a.depth),
                      .ids = static_cast<bool>(a.ids),
                      .overdraw = static_cast<bool>(a.heatmap),
                      .errors = static_cast<bool>(a.errors)};
  Pictures pictures;
  const std::vector<FrameStats> frames = render_frames(
      *renderer, binding.view(), camera, wanted, timed, a.frames, pictures, timeline, progress);
  const FrameStats& median = frames[median_frame(frames)];
  progress.clear();
  if (!a.quiet) report_missing(median);

  write_images(a, pictures, timeline, progress);
  progress.clear();
  if (a.stats) write_json(a.stats.file, stats_json(frames, renderer->options(), load_ms));
  if (a.trace) write_trace(a.trace.file, timeline);
  if (!a.quiet && a.color)
    std::fprintf(stderr, "%s: %dx%d, %lu triangles, %.1f ms%s\n", a.color.file.c_str(),
                 a.render.width, a.render.height,
                 static_cast<unsigned long>(median.triangles.input), median.frame_ms,
                 timed ? " a frame" : "");
  return 0;
}

}  // namespace

Command add_render_command(CLI::App& app) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App& render = *app.add_subcommand("render", "Draw meshes and shapes into an image file");
  render
      .add_option(
          "INPUT", arguments->inputs,
          "files (.obj .ply .stl .off .gltf .glb) and builtin:SHAPE[?name=value,...], drawn "
          "as one scene in this order; x, y, z and scale place a shape")
      ->required()
      ->type_name("");
  add_output_options(render, *arguments);
  add_picture_options(render, *arguments);
  add_transparency_options(render, *arguments);
  add_camera_options(render, *arguments);
  add_machine_options(render, *arguments);
  std::string footer = "Shapes and their defaults:\n";
  for (const shapes::ShapeInfo& shape : shapes::catalogue())
    footer +=
        "  builtin:" + shape.name + (shape.parameters.empty() ? "" : "?") + shape.parameters + "\n";
  footer +=
      "\nTimes: a frame goes from the mesh in memory to the finished 8-bit image in memory. With\n"
      "--frames, --stats or --trace the timed frames fill that image alone, and one more pass,\n"
      "which is not timed, fills the others; without them one pass fills all.\n"
      "\nExamples:\n"
      "  rastrum render bunny.obj -o bunny.png\n"
      "  rastrum render scene.glb --camera 0 --size 1920x1080 --background '#20242c' -o scene.png\n"
      "  rastrum render a.stl b.ply --eye 3,2,5 --target 0,0,0 --depth d.npy --ids i.npy -o c.exr\n"
      "  rastrum render builtin:teapot 'builtin:sphere?x=3,scale=0.5' --shader normal -o two.png\n"
      "  rastrum render engine.glb --opacity 0.3 --samples 4 -o see_through.png\n"
      "  rastrum render hair.ply --opacity 0.5 --transparency filter:3 --show-errors wrong.png\n"
      "  rastrum render dragon.ply --frames 20 --stats - --trace frames.json --heatmap heat.png";
  render.footer(footer);
  return {&render, [arguments] { return run(*arguments); }};
}

}  // namespace rastrum::cli
