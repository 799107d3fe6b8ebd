// SPDX-License-Identifier: BSD-3-Clause
// `rastrum make SHAPE -o FILE.ply`: procedural and subdivided meshes as files.
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include <rastrum/io.hpp>
#include <rastrum/shapes.hpp>

#include "commands.hpp"
#include "files/output_files.hpp"
#include "flatten.hpp"
#include "job/inputs.hpp"
#include "job/progress.hpp"
#include "parse/arguments.hpp"
#include "parse/output.hpp"
#include "parse/scene_options.hpp"

namespace rastrum::cli {
namespace {

/// 4^12 triangles for one; beyond, no index can number them.
constexpr int kMaxSubdivisions = 12;

struct MakeArguments {
  std::string input;
  InputReading reading;
  Output output;
  int subdivide = 0;
  bool quiet = false;
};

/// A name of the catalogue is a shape; what else looks like a path is a file.
bool is_shape(const std::string& input) {
  const std::string name = input.substr(0, input.find_first_of("?@"));
  for (const shapes::ShapeInfo& shape : shapes::catalogue())
    if (shape.name == name) return true;
  const std::string plain = input.substr(0, input.find('?'));
  return plain != "-" && !plain.starts_with("-@") &&
         plain.find_first_of("./:") == std::string::npos;
}

int run(const MakeArguments& a) {
  const std::string input = is_shape(a.input) ? "builtin:" + a.input : a.input;
  check_inputs({input}, a.reading.format);
  remember_inputs({input});
  const Output* const outputs[] = {&a.output};
  check_outputs(outputs);
  Progress progress(a.quiet);
  progress.show("making " + a.input);
  Scene scene = load_input(input, a.reading);
  check_outputs(outputs);  // the input may name files
  const bool is_of_surfaces =
      scene.meshes.empty() && !scene.geometries.empty() && is_shape(a.input);
  if (is_of_surfaces)
    throw UsageError(a.input,
                     "is not a mesh, and PLY has no such surfaces; `rastrum render` draws them");
  Flattened flat = flatten(std::move(scene));
  if (a.subdivide > 0) flat.mesh = shapes::subdivide(flat.mesh, a.subdivide);
  progress.clear();
  if (!a.quiet)
    for (const std::string& w : flat.warnings) warn(w);
  OutputFiles files;
  const bool is_cloud = !flat.points.positions.empty();
  if (is_cloud)
    io::write_ply(files.begin(a.output), flat.points);
  else
    io::write_ply(files.begin(a.output), flat.mesh);
  files.commit();
  if (!a.quiet && is_cloud)
    std::fprintf(stderr, "%s: %zu points\n", a.output.name().c_str(), flat.points.positions.size());
  else if (!a.quiet)
    std::fprintf(stderr, "%s: %zu vertices, %zu triangles\n", a.output.name().c_str(),
                 flat.mesh.positions.size(), flat.mesh.triangle_count());
  return 0;
}

}  // namespace

Command add_make_command(Parser& app) {
  auto arguments = std::make_shared<MakeArguments>();
  Parser make = app.add_subcommand("make", "Write a shape, or a file's mesh, as binary PLY");
  make.add_option("SHAPE", arguments->input,
                  "SHAPE[?name=value,...] of the list below, or a file; "
                  "@x=X,y=Y,z=Z,scale=S,rx=DEG,... places it; - is standard input")
      ->required()
      ->type_name("");
  add_reading_options(make, arguments->reading);
  add(make, "-o,--output", "FILE", "the .ply file; - is standard output",
      [arguments](const std::string& s) {
        arguments->output = parse_output("-o", s, {Format::ply});
      })
      ->required();
  add_integer(make, "--subdivide", "K", "split every triangle into 4, K times (default: 0)",
              arguments->subdivide, 0, kMaxSubdivisions);
  make.add_flag("--quiet", arguments->quiet, "print only errors");
  std::string footer = "Shapes and their defaults:\n";
  for (const shapes::ShapeInfo& shape : shapes::catalogue())
    footer += "  " + shape.name + (shape.parameters.empty() ? "" : "?") + shape.parameters +
              "\n      " + shape.description + "\n";
  footer +=
      "\nExamples:\n"
      "  rastrum make 'torus_knot?p=3,q=5' -o knot.ply\n"
      "  rastrum make bunny.obj --subdivide 2 -o bunny16.ply";
  make.footer(footer);
  return {make, [arguments] { return run(*arguments); }};
}

}  // namespace rastrum::cli
