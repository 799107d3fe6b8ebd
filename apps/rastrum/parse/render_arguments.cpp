// SPDX-License-Identifier: BSD-3-Clause
#include "render_arguments.hpp"

#include <utility>

#include "annotations.hpp"
#include "arguments.hpp"

namespace rastrum::cli {
namespace {

void add_output_options(Parser app, RenderArguments& a) {
  app = app.under("Outputs");
  add(app, "-o,--output", "FILE",
      "the picture. .png: 8 bit, straight alpha; .exr, .npy: float32, premultiplied; with --path "
      "or --turntable also .mp4, over black; - is standard output, here and below",
      [&a](const std::string& s) { a.color_file = s; });
  add_choice(app, "--output-format", "NAME",
             "format of -o where its name does not tell it: png, exr, npy (default: png)",
             a.color_format, {{"png", Format::png}, {"exr", Format::exr}, {"npy", Format::npy}});
  add_output(
      app, "--depth",
      "depth of the nearest surface, .npy or .exr: float32, 1 near, 0 far and where nothing is",
      a.outputs.depth, {Format::npy, Format::exr});
  add_choice(app, "--depth-unit", "NAME",
             "what --depth writes: reversed (1 near, 0 far), or world: the distance along the view "
             "axis in the scene's units, inf where nothing is (default: reversed)",
             a.depth_unit, {{"world", DepthUnit::world}, {"reversed", DepthUnit::reversed}});
  add_output(app, "--ids",
             "number of the triangle that is seen, in order of submission, .npy: int64, -1 where "
             "nothing is",
             a.outputs.ids, {Format::npy});
  add_output(app, "--objects",
             "number of the INPUT that is seen, from 0 in the command line's order, .npy: int32, "
             "-1 where nothing is",
             a.outputs.objects, {Format::npy});
  app.add_repeated(
      "--image", "NAME=FILE",
      "another image of the frame (docs/outputs.md), .npy, or .exr if a pixel has one, three or "
      "four floats; may be repeated. Names: " +
          frame_image_names(),
      [&a](const std::string& s) { a.outputs.images.push_back(parse_frame_image(s)); });
  add_output(app, "--heatmap",
             "how many fragments each pixel has, hidden ones too, as colours, .png; stderr gets "
             "the legend",
             a.outputs.heatmap, {Format::png});
  add_output(app, "--show-errors",
             "the picture in grey, .png; a pixel is red where filter:K blended in a wrong order, "
             "or where exact had to sort more fragments than its filter holds",
             a.outputs.errors, {Format::png});
  add_output(app, "--stats", "counts, memory, times, ids of the inputs and cameras, .json", a.stats,
             {Format::json});
  add_output(app, "--trace", "stages of the frames for chrome://tracing or ui.perfetto.dev, .json",
             a.trace, {Format::json});
  add_hash_option(app, a);
  app.add_flag("--quiet", a.quiet, "print only errors: no warnings, legend, summary or progress");
}

void add_sequence_options(Parser app, RenderArguments& a) {
  app = app.under("Many pictures");
  add_integer(app, "--turntable", "N",
              "draw N pictures of a full turn around the camera's target: -o 'turn_%03d.png' or, "
              "through ffmpeg, -o turn.mp4",
              a.turntable, 1, 1000000);
  add_path_options(app, a, "pictures a second of the path or the film (default: 30)");
  app = app.under("Motion");
  add_number_that(
      app, "--time", "S",
      "the moment of the files' animation, in seconds; an animation that has ended begins again "
      "(default: the files as they stand; along --path the time of each picture)",
      a.time_s, [](double seconds) { return seconds >= 0; }, "must not be negative");
  add_integer(app, "--animation", "N",
              "which animation to take, as `rastrum info` counts them (default: 0)", a.animation, 0,
              1000000);
}

void add_drawing_options(Parser app, RenderArguments& a) {
  app = app.under(kMachineGroup);
  add_frames_option(app, a);
  app.add_flag(
      "--prepare", a.prepares,
      "sort the meshes' triangles into clusters first, so that each picture can leave out hidden "
      "ones; it pays for --frames, --turntable and --path of about ten pictures or more");
  add_choice(
      app, "--out-of-core", "NAME",
      "draw a binary .ply, .stl, .glb or .npy chunk by chunk within --memory-limit, without "
      "reading it into memory (docs/large_files.md); auto: if a single INPUT takes more than the "
      "limit and the limit is 64M or more; always: within 2G if no limit is given; never (default: "
      "auto)",
      a.out_of_core,
      {{"auto", OutOfCore::automatic}, {"always", OutOfCore::always}, {"never", OutOfCore::never}});
  add_number_that(
      app, "--timeout", "S",
      "with mpirun: end the job if a rank waits longer than this for the others, in seconds, and "
      "say in which phase (default: wait for ever)",
      a.timeout_s, is_above_zero, "must be greater than 0");
}

/// All outputs of a picture, asked for or not.
template <class Outputs>
auto all_of(Outputs& o) {
  std::vector<decltype(&o.color)> all{&o.color,   &o.depth,   &o.ids,
                                      &o.objects, &o.heatmap, &o.errors};
  for (auto& image : o.images) all.push_back(&image.output);
  return all;
}

}  // namespace

std::vector<const Output*> PictureOutputs::asked_for() const {
  std::vector<const Output*> outputs = all_of(*this);
  std::erase_if(outputs, [](const Output* output) { return !*output; });
  return outputs;
}

PictureOutputs PictureOutputs::numbered(std::size_t number, std::size_t count) const {
  PictureOutputs outputs = *this;
  for (Output* const output : all_of(outputs))
    *output = cli::numbered(std::move(*output), number, count);
  return outputs;
}

void add_render_options(Parser app, RenderArguments& a) {
  add_input_option(app, a)->required();
  add_output_options(app, a);
  add_picture_options(app, a);
  add_look_option(app, a);
  add_transparency_options(app, a);
  add_annotation_options(app, a.annotations);
  add_camera_options(app, a.view);
  add_sequence_options(app, a);
  add_machine_options(app, a);
  add_drawing_options(app, a);
}

void settle(RenderArguments& a) {
  PictureOutputs& o = a.outputs;
  if (a.color_file)
    o.color = parse_output("-o", *a.color_file,
                           {Format::png, Format::exr, Format::npy, Format::mp4}, a.color_format);
  else if (a.color_format)
    throw UsageError("--output-format", "needs -o");
  if (o.asked_for().empty() && !a.stats && !a.trace && !a.hash)
    throw UsageError("-o", "say where the picture goes, as in -o picture.png");
  // Numbers beside the colours mean that the picture is compared, not only shown.
  const bool asks_for_numbers = o.asked_for().size() > (o.color ? 1 : 0);
  set_look(a, is_to_be_shown(a) && !asks_for_numbers, a.path.empty(), a.has_colors());
  check_scene_arguments(a);
  check_annotations(a.annotations, a.has_colors());
  if (a.depth_unit && !o.depth) throw UsageError("--depth-unit", "needs --depth");
  if (a.animation && !a.time_s && a.path.empty())
    throw UsageError("--animation", "needs --time or --path");
  if (!a.is_sequence() && a.fps) throw UsageError("--fps", "needs --path or --turntable");
  if (!a.is_sequence() && o.color.is_film())
    throw UsageError("-o", "an .mp4 needs several pictures: give --path or --turntable");
  if (a.is_sequence() && a.frames)
    throw UsageError("--frames", std::string("cannot go with ")
                                     .append(a.path.empty() ? "--turntable" : "--path")
                                     .append(": both say how many frames are drawn"));
  if (!a.path.empty() && a.turntable != 0)
    throw UsageError("--turntable", "cannot go with --path: both move the camera");
  if (a.turntable != 0 && a.view.file_camera)
    throw UsageError("--turntable",
                     "the camera of a file has no target to turn around: give --eye and --target");
  if (a.is_sequence()) static_cast<void>(o.numbered(0, 1));  // throws for a wrong %d
  a.view.turns = a.turntable != 0;
}

void check_files(const RenderArguments& a) {
  remember_inputs(a.inputs);
  std::vector<const Output*> outputs = a.outputs.asked_for();
  outputs.insert(outputs.end(), {&a.trace, &a.stats});
  check_outputs(outputs, a.hash);
}

}  // namespace rastrum::cli
