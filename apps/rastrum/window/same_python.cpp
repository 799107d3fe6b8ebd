// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <rastrum/core/srgb.hpp>

#include "parse/input_spec.hpp"
#include "picture_text.hpp"
#include "same_parts.hpp"

namespace rastrum::cli::window {
namespace {

std::string python_camera(const Camera& c) {
  Call camera(c.orthographic ? "rr.Camera.orthographic" : "rr.Camera.look_at");
  camera(tuple(c.eye))(tuple(c.target))(tuple(c.up));
  if (c.orthographic)
    camera("height", number(static_cast<double>(c.orthographic_height)));
  else
    camera("fov", number(degrees(c.fov_rad)));
  camera("near", number(static_cast<double>(c.near_plane)));
  if (std::isfinite(c.far_plane))
    camera("far", number(static_cast<double>(c.far_plane)));
  else if (c.orthographic)
    camera("far", "float(\"inf\")");
  return camera.text();
}

/// The 8-bit display colour from which --light and Python make this linear one.
std::string display_hex(Vec3 linear) {
  const auto byte = [](float wanted) {
    for (int i = 0; i < 256; ++i) {
      const float display = static_cast<float>(i) / 255.0F;
      if (static_cast<float>(linear_from_srgb(static_cast<double>(display))) == wanted)
        return display;
    }
    return 1.0F;
  };
  return hex({byte(linear.x), byte(linear.y), byte(linear.z), 1}).substr(0, 7);
}

/// `text`: the option's, which names an environment's picture.
std::string python_light(const Light& light, const std::string& text) {
  constexpr const char* kKinds[] = {"ambient", "hemisphere", "directional",
                                    "point",   "spot",       "environment"};
  Call said(std::string("rr.Light.").append(kKinds[light.kind.index()]));
  const auto add_range = [&](float range) {
    if (std::isfinite(range)) said("range", number(static_cast<double>(range)));
  };
  if (const auto* const h = std::get_if<HemisphereLight>(&light.kind)) {
    said(tuple(Vec3d(h->up)));
    if (h->below != Vec3{}) said("below", literal(display_hex(h->below)));
  } else if (const auto* const d = std::get_if<DirectionalLight>(&light.kind)) {
    said(tuple(Vec3d(d->direction)));
  } else if (const auto* const p = std::get_if<PointLight>(&light.kind)) {
    said(tuple(p->position));
    add_range(p->range);
  } else if (const auto* const s = std::get_if<SpotLight>(&light.kind)) {
    said(tuple(s->position))(tuple(Vec3d(s->direction)));
    said("inner", number(degrees(s->inner_rad)))("outer", number(degrees(s->outer_rad)));
    add_range(s->range);
  } else if (const auto* const e = std::get_if<EnvironmentLight>(&light.kind)) {
    const std::size_t begin = text.find(':') + 1;
    said(literal(text.substr(begin, text.find(':', begin) - begin)));
    said("up", tuple(Vec3d(e->up)));
    if (e->turn_rad != 0) said("turn", number(degrees(e->turn_rad)));
  }
  if (light.color != Vec3{1, 1, 1}) said("color", literal(display_hex(light.color)));
  if (light.intensity != 1) said("intensity", number(static_cast<double>(light.intensity)));
  if (light.of_camera) said("of_camera", "True");
  return said.text();
}

}  // namespace

std::string python_lights(const std::string& name, bool as_given, const std::vector<Light>& lights,
                          const std::vector<Parser::Given>& given) {
  std::vector<std::string> all;
  if (!name.empty() && name != "file") all.push_back(literal(name));
  if (as_given) {
    // Lights of --light follow those of --lights.
    std::vector<std::string> texts;
    for (const Parser::Given& g : given)
      if (g.name == "--light") texts.insert(texts.end(), g.texts.begin(), g.texts.end());
    for (std::size_t i = 0; i < texts.size(); ++i)
      all.push_back(python_light(lights[lights.size() - texts.size() + i], texts[i]));
  }
  if (name == "file") all.push_back(literal(name));
  return all.size() == 1 ? all.front() : all.empty() ? "" : listed(all);
}

namespace {

/// Options that the window repeats and Python has.
constexpr std::string_view kPythonHas[] = {
    "--clip-plane",   "--crease",        "--cull",           "--environment-behind",
    "--title",        "--caption",       "--text-scale",     "--occlusion-radius",
    "--edl-strength", "--edge-angle",    "--edge-width",     "--occlusion-strength",
    "--symmetric",    "--categories",    "--below",          "--above",
    "--nan-color",    "--isolines",      "--scalar-opacity", "--isoline-color",
    "--light",        "--isoline-width", "--bar-unit"};

/// Names the options and inputs that Python's render lacks.
std::string without_words(const ShownPicture& shown) {
  const MeshSettings& s = shown.settings;
  std::string all;
  const auto add = [&](const std::string& option) { all += (all.empty() ? "" : ", ") + option; };
  for (const Parser::Given& g : shown.arguments.given)
    if (std::ranges::find(kPythonHas, g.name) == std::end(kPythonHas) && is_repeated(g.name, s))
      add(g.name);
  for (const std::string& input : shown.arguments.inputs) {
    const InputSpec spec = parse_input(input);
    if (spec.placement != Placement{} || spec.look.given() || input == "-") add(input);
  }
  return all;
}

}  // namespace

std::string python_mapping(const std::string& map, const ScalarOptions& scalars) {
  const ScalarMapping& m = scalars.mapping;
  std::vector<std::string> colors;
  if (map.find('#') != std::string::npos)
    for (const Vec4& c : m.map.colors) colors.push_back(literal(hex(c)));
  std::vector<std::string> said{colors.empty() ? literal(map) : listed(colors)};
  if (m.range) said.push_back(in_brackets({number(m.range->low), number(m.range->high)}));
  if (m.logarithmic) said.emplace_back("log=True");
  if (m.symmetric) said.emplace_back("symmetric=True");
  if (m.steps != 0) said.push_back("steps=" + std::to_string(m.steps));
  if (!m.categories.empty()) said.push_back("categories=" + listed(m.categories));
  if (m.below) said.push_back("below=" + literal(hex(*m.below)));
  if (m.above) said.push_back("above=" + literal(hex(*m.above)));
  const ScalarMapping usual;
  if (m.nan != usual.nan && hex(m.nan) != hex(usual.nan))
    said.push_back("nan=" + literal(hex(m.nan)));
  std::vector<std::string> opacity;
  for (const ScalarOpacity& o : m.opacity)
    opacity.push_back(in_brackets({number(o.value), number(static_cast<double>(o.opacity))}));
  if (!opacity.empty()) said.push_back("opacity=" + listed(opacity));
  const int count = scalars.isoline_count;
  if (!m.isolines.empty() || count != 0) {
    said.push_back("isolines=" + (count != 0 ? std::to_string(count) : listed(m.isolines)));
    said.push_back("isoline_color=" + literal(hex(m.isoline_color)));
    said.push_back("isoline_width=" + number(static_cast<double>(m.isoline_px)));
  }
  return said.size() == 1 ? said.front() : "rr.ColorMapping(" + joined(said) + ")";
}

std::string python_notes(const AnnotationOptions& a) {
  std::vector<std::string> notes;
  const auto add = [&](const char* name, bool on,
                       std::initializer_list<std::pair<const char*, std::optional<double>>> given) {
    std::vector<std::string> options;
    for (const auto& [option, value] : given)
      if (value) options.push_back(literal(option) + ": " + number(*value));
    if (on) notes.push_back(literal(name) + ": {" + joined(options) + "}");
  };
  add("occlusion", a.occlusion,
      {{"radius", a.occlusion_radius}, {"strength", a.occlusion_strength}});
  add("edl", a.dome, {{"strength", a.dome_strength}});
  add("silhouettes", a.silhouettes, {});
  add("edges", a.edges, {{"angle", a.edge_angle}, {"width", a.edge_width}});
  add("axes", a.axes, {});
  add("bounds", a.bounds, {});
  if (const ScalarOptions& o = a.scalars; o.bar())
    notes.push_back("\"bar\": {\"title\": " + literal(*o.bar_title) + ", \"unit\": " +
                    literal(o.bar_unit) + (o.nan_given ? ", \"nan\": True}" : "}"));
  if (!a.words.title.empty()) notes.push_back("\"title\": " + literal(a.words.title));
  std::vector<std::string> captions;
  for (const std::string& c : a.words.captions) captions.push_back(literal(c));
  if (!captions.empty()) notes.push_back("\"captions\": " + listed(captions));
  if (!notes.empty() && a.words.scale_given)
    notes.push_back("\"text_scale\": " + number(a.words.scale));
  return notes.empty() ? "" : "{" + joined(notes) + "}";
}

std::string python_lines(const ShownPicture& shown, const std::string& png) {
  const MeshSettings& s = shown.settings;
  const family::Options frame = s.frame(shown.width, shown.height);
  std::string all = "import rastrum as rr\n\n";
  if (const std::string missing = without_words(shown); !missing.empty())
    all += "# Left out here, since the Python package does not have it: " + missing + "\n";
  std::vector<std::string> files;
  for (const std::string& input : shown.arguments.inputs)
    files.push_back(literal(parse_input(input).source));
  Call scene("rr.Scene");
  scene(listed(files));
  if (shown.arguments.crease_given) scene("crease", number(shown.arguments.normals.crease_deg));
  const ScalarOptions& o = s.notes.scalars;
  if (!o.name.empty()) scene("scalars", literal(o.name))("cmap", python_mapping(s.map, o));
  Call picture("rr.render");
  picture("scene")("camera")(
      "size", in_brackets({std::to_string(shown.width), std::to_string(shown.height)}));
  picture("shader", literal(std::string(name(frame.shader))));
  if (frame.background.w != 0) picture("background", literal(hex(frame.background)));
  if (frame.samples != 1) picture("samples", std::to_string(frame.samples));
  if (frame.opacity != 1) picture("opacity", number(static_cast<double>(frame.opacity)));
  if (frame.transparency.method != Transparency::exact)
    picture("transparency", literal(transparency_name(frame.transparency)));
  if (frame.cull != Cull::none)
    picture("cull", literal(frame.cull == Cull::back ? "back" : "front"));
  if (const std::string lights = python_lights(lights_name(shown), s.lights.empty(),
                                               s.render.lights, shown.arguments.given);
      !lights.empty())
    picture("lights", lights);
  if (frame.shadows) picture("shadows", "True");
  if (frame.shadows && frame.shadow_size != 0)
    picture("shadow_size", std::to_string(frame.shadow_size));
  if (frame.shadows && frame.shadow_distance != 0)
    picture("shadow_distance", number(frame.shadow_distance));
  if (frame.environment_behind) picture("environment_behind", "True");
  say_tone(picture, frame.tone);
  if (!frame.clip_planes.empty()) {
    std::vector<std::string> planes;
    for (const ClipPlane& p : frame.clip_planes)
      planes.push_back(in_brackets(
          {number(p.normal.x), number(p.normal.y), number(p.normal.z), number(p.offset)}));
    picture("clip_planes", listed(planes));
  }
  if (const std::string notes = python_notes(s.notes); !notes.empty()) picture("annotate", notes);
  return all + "scene = " + scene.text() + "\ncamera = " + python_camera(shown.camera) +
         "\npicture = " + picture.text() + "\npicture.save(" + literal(png) + ")\n";
}

}  // namespace rastrum::cli::window
