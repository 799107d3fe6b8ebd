// SPDX-License-Identifier: BSD-3-Clause
#include "scene_options.hpp"

#include <algorithm>
#include <string_view>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/primitives.hpp>
#include <rastrum/shapes.hpp>

#include "light_options.hpp"

namespace rastrum::cli {
namespace {

void add_axis(Parser& app, const char* option, const std::vector<family::AxisInfo>& axis,
              std::string& value) {
  const std::vector<std::string> names = axis_names(axis);
  add(app, option, "NAME", joined(names) + " (default: auto)", [=, &value](const std::string& s) {
    if (std::ranges::find(names, s) == names.end())
      throw UsageError(option, "expected one of " + joined(names) + ", got '" + s + "'");
    value = s;
  });
}

Shader parse_shader(const std::string& text) {
  try {
    return shader_from_name(text);
  } catch (const Error& e) {
    throw UsageError("--shader", e.what());
  }
}

constexpr std::string_view kFilter = "filter:";

struct Named {
  std::string_view name;
  TransparencyOptions options;
};
const std::vector<Named>& methods() {
  static const std::vector<Named> list{{"exact", {}},
                                       {"filter:3", family::filtered(3)},
                                       {"unsorted", {Transparency::unsorted}},
                                       {"wboit", family::wboit()},
                                       {"mboit4", family::mboit4()},
                                       {"mboit6", family::mboit6()},
                                       {"mlab4", family::mlab4()},
                                       {"none", {Transparency::none}}};
  return list;
}

bool same_method(const TransparencyOptions& a, const TransparencyOptions& b) {
  return a.method == b.method && a.added == b.added;
}

}  // namespace

std::vector<std::string> axis_names(const std::vector<family::AxisInfo>& axis) {
  std::vector<std::string> names{"auto"};
  for (const family::AxisInfo& info : axis) names.push_back(info.name);
  return names;
}

std::string transparency_list() {
  std::string words;
  for (const Named& m : methods())
    words.append(words.empty() ? "" : ", ")
        .append(m.name.starts_with(kFilter) ? "filter:K" : m.name);
  return words;
}

int filter_of(const TransparencyOptions& options) {
  for (int k = 1; k <= 64; ++k)
    if (same_method(options, family::filtered(k))) return k;
  return 0;
}

std::string transparency_name(const TransparencyOptions& options) {
  if (const int k = filter_of(options); k != 0) return std::string(kFilter) + std::to_string(k);
  for (const Named& m : methods())
    if (same_method(options, m.options)) return std::string(m.name);
  return {};
}

std::vector<std::string> transparency_names(const TransparencyOptions& now) {
  std::vector<std::string> names;
  for (const Named& m : methods())
    names.emplace_back(m.name.starts_with(kFilter) && filter_of(now) != 0 ? transparency_name(now)
                                                                          : m.name);
  return names;
}

void parse_transparency(const std::string& text, TransparencyOptions& options) {
  TransparencyOptions found;
  const auto known = std::ranges::find(methods(), text, &Named::name);
  if (known != methods().end())
    found = known->options;
  else if (text.starts_with(kFilter))
    found = family::filtered(
        parse_integer("--transparency", std::string_view(text).substr(kFilter.size()), 1, 64));
  else
    throw UsageError("--transparency",
                     "expected one of " + transparency_list() + ", got '" + text + "'");
  options.method = found.method;
  options.added = found.added;
}

float parse_alpha_threshold(const std::string& text) {
  if (text.empty()) return 1 - 1 / 128.0F;
  return static_cast<float>(parse_number_that(
      "--alpha-threshold", text, [](double alpha) { return alpha > 0 && alpha <= 1; },
      "must be > 0 and at most 1"));
}

Option add_input_option(Parser& app, SceneArguments& a) {
  add_reading_options(app, a.reading);
  return app
      .add_option("INPUT", a.inputs,
                  "files (.obj .ply .stl .off .gltf .glb .npy) and shapes "
                  "(builtin:SHAPE[?name=value,...]), drawn as one scene in this order; "
                  "INPUT@x=X,y=Y,z=Z,scale=S,rx=DEG,ry=DEG,rz=DEG,color=#RRGGBB,opacity=A places "
                  "and paints one of them; - is standard input")
      ->type_name("");
}

void add_reading_options(Parser app, InputReading& reading) {
  app = app.under("Inputs");
  const std::string known = joined(io::scene_formats());
  add(app, "--format", "NAME",
      known + ": the format of inputs whose name does not tell it, such as -",
      [&reading, known](const std::string& s) {
        const std::vector<std::string_view> names = io::scene_formats();
        if (std::ranges::find(names, s) == names.end())
          throw UsageError("--format", "expected one of " + known + ", got '" + s + "'");
        reading.format = s;
      });
  add_choice(app, "--allow-outside", "NAME",
             "whether a file may name other files outside of its folder: yes, no (default: yes)",
             reading.options.allow_outside, {{"yes", true}, {"no", false}});
}

void add_shading_options(Parser app, SceneArguments& a) {
  add(app, "--shader", "NAME",
      joined(shader_names()) +
          "; auto takes material where a file has materials, else phong (default: auto)",
      [&a](const std::string& s) { a.render.shader = parse_shader(s); });
  add_choice(
      app, "--normals", "NAME",
      "file: the file's own, or as crease where it has none; crease: smooth except at sharp edges; "
      "vertex: area-weighted means, smooth everywhere; face: flat faces (default: file)",
      a.normals.kind,
      {{"file", Normals::file},
       {"crease", Normals::crease},
       {"vertex", Normals::vertex},
       {"face", Normals::face}});
  add(app, "--crease", "DEG",
      "an edge stays sharp where its faces meet at more than this angle; at 180 no edge does "
      "(default: 40)",
      [&a](const std::string& s) {
        a.normals.crease_deg = parse_number_that(
            "--crease", s, [](double deg) { return deg >= 0 && deg <= 180; },
            "must lie in 0 to 180 degrees");
        a.crease_given = true;
      });
  const auto add_size = [&](const char* option, float most, const char* what, float& size) {
    add(app, option, "PX", what, [option, most, &size](const std::string& s) {
      size = static_cast<float>(parse_number(option, s));
      if (!(size > 0 && size <= most))
        throw UsageError(option, "must be > 0 and at most " +
                                     std::to_string(static_cast<int>(most)) + " px, got '" + s +
                                     "'");
    });
  };
  add_size("--point-size", kMaxPointSize, "side of the points of files in pixels (default: 1)",
           a.sizes.point);
  add_size("--line-width", kMaxLineWidth, "width of the lines of files in pixels (default: 1)",
           a.sizes.line);
  add_choice(app, "--cull", "NAME",
             "which side of surfaces to leave out: none, back, front; a face is seen from the "
             "front where its corners run counter-clockwise; even with none the material shader "
             "leaves out the back of single-sided glTF materials (default: none)",
             a.render.cull, {{"none", Cull::none}, {"back", Cull::back}, {"front", Cull::front}});
  app.add_repeated("--clip-plane", "X,Y,Z,D",
                   "draw only what lies where X x + Y y + Z z + D >= 0 in the world; may be "
                   "repeated, up to eight times",
                   [&a](const std::string& s) {
                     a.render.clip_planes.push_back(parse_clip_plane("--clip-plane", s));
                     if (a.render.clip_planes.size() > kMaxClipPlanes)
                       throw UsageError("--clip-plane", "at most eight planes are possible");
                   });
}

void add_picture_options(Parser app, SceneArguments& a) {
  app = app.under("Picture");
  add_size(app, a.render);
  add_shading_options(app, a);
  add_light_options(app, a.render, a.lights);
  add(app, "--background", "COLOUR",
      "colour behind the scene: #rrggbb[aa], #rgb[a] or a name of CSS (default: transparent)",
      [&a](const std::string& s) { a.render.background = parse_color("--background", s); });
}

void add_blending_options(Parser app, SceneArguments& a) {
  add_number_that(
      app, "--opacity", "A",
      "opacity of every surface, 0 to 1: opaque and masked materials get alpha A, materials that "
      "blend get their alpha times A (default: 1)",
      a.render.opacity, [](double opacity) { return opacity >= 0 && opacity <= 1; },
      "must lie in 0 to 1");
  add(app, "--transparency", "NAME",
      transparency_list() +
          "; filter:K sorts by blocks and by K fragments a pixel, and repairs no pixel whose order "
          "is wrong; none draws translucent surfaces as opaque (default: exact)",
      [&a](const std::string& s) { parse_transparency(s, a.render.transparency); });
  add(app, "--alpha-threshold", "[A]",
      "leave out what lies farther back once a pixel has this alpha; without A it is 1 - 1/128 "
      "(default: 1, which leaves out nothing)",
      [&a](const std::string& s) {
        a.render.transparency.alpha_threshold = parse_alpha_threshold(s);
      })
      ->expected(0, 1);
}

void add_transparency_options(Parser app, SceneArguments& a) {
  app = app.under("Transparency and samples");
  add_blending_options(app, a);
  add(app, "--samples", "N",
      "samples a pixel: 1, 4, 8 or 16, at D3D11's standard positions; --ids and --depth show the "
      "nearest sample (default: 4 where only -o is asked for, docs/light.md; else 1)",
      [&a](const std::string& s) {
        a.samples_given = true;
        a.render.samples = choose<int>("--samples", s, {{"1", 1}, {"4", 4}, {"8", 8}, {"16", 16}});
      });
}

void add_rasterizer_options(Parser app, SceneArguments& a) {
  add_axis(app, "--rasterizer", family::rasterizer_axis(), a.render.rasterizer);
  add_axis(app, "--visibility", family::visibility_axis(), a.render.visibility);
  add(app, "--memory-limit", "BYTES",
      "most memory beside the mesh and the images, with K, M or G; what does not fit at once is "
      "drawn piece by piece; with --out-of-core the mesh and the images count, too; a file may "
      "take 64 times its size in memory, and as much as this on top (default: no limit; 1G on top "
      "for a file)",
      [&a](const std::string& s) {
        a.render.memory_limit = parse_bytes("--memory-limit", s);
        if (a.render.memory_limit != 0) a.reading.options.memory_limit = a.render.memory_limit;
      });
}

void add_machine_options(Parser app, SceneArguments& a) {
  app = app.under(kMachineGroup);
  add_rasterizer_options(app, a);
  add_device_options(app, a.render);
}

void add_look_option(Parser app, SceneArguments& a) {
  app = app.under("Picture");
  add_choice(app, "--look", "NAME",
             "studio: --view iso --fov 30 --lights studio --occlusion --samples 4; plain: --view "
             "front --lights default --samples 1; each of these options that you give yourself "
             "wins (default: studio where only -o is asked for, docs/light.md)",
             a.look, {{"studio", LookName::studio}, {"plain", LookName::plain}});
}

bool is_to_be_shown(const SceneArguments& a) {
  const family::Options& r = a.render;
  return (r.device == Device::threads || r.device == Device::serial) && r.rasterizer == "auto" &&
         r.visibility == "auto";
}

void set_look(SceneArguments& a, bool shows, bool has_corner, bool has_colors) {
  if (a.look == LookName::plain) return;
  const bool studio = a.look == LookName::studio;
  shows |= studio;
  ViewOptions& v = a.view;
  if (!v.has_view() && !v.eye && !v.target && !v.file_camera && has_corner) {
    v.view = ViewName::iso;
    // Wider lenses make near parts too large, in a look at over twenty files.
    if (!v.fov_deg) v.fov_deg = 30;
  }
  if (!a.samples_given && shows) a.render.samples = 4;
  const bool lights = studio || (shows && a.render.shader == Shader::automatic);
  if (!a.lights.given && lights) a.render.lights = light_kit();
  const bool occludes = studio || (lights && !a.lights.given);
  if (occludes && has_colors) a.annotations.occlusion = true;
}

std::string shapes_help() {
  std::string text = "Shapes and their defaults:\n";
  for (const shapes::ShapeInfo& shape : shapes::catalogue())
    text +=
        "  builtin:" + shape.name + (shape.parameters.empty() ? "" : "?") + shape.parameters + "\n";
  return text;
}

void check_scene_arguments(const SceneArguments& a) {
  check_inputs(a.inputs, a.reading.format);
  if (a.render.shadows && a.render.lights.empty() && !a.lights.of_files)
    throw UsageError("--shadows", "needs lights, as in --lights studio --shadows");
  if (!a.render.shadows && (a.render.shadow_size != 0 || a.render.shadow_distance != 0))
    throw UsageError(a.render.shadow_size != 0 ? "--shadow-size" : "--shadow-distance",
                     "needs --shadows");
  if (a.render.environment_behind && !has_environment(a.render.lights))
    throw UsageError("--environment-behind", "needs an environment, as in --light environment:sky");
  if (a.crease_given && (a.normals.kind == Normals::vertex || a.normals.kind == Normals::face))
    throw UsageError("--crease", "needs --normals file or --normals crease");
  check_view(a.view);
}

}  // namespace rastrum::cli
