#include "same_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "transparency.hpp"

namespace rastrum::cli::window {
namespace {

/// Options that the window says itself, or that are of windows alone.
constexpr std::string_view kSaid[] = {
    "--size",       "--shader",      "--background",   "--opacity", "--transparency", "--samples",
    "--rasterizer", "--visibility",  "--look",         "--device",  "--threads",      "--isa",
    "--shadows",    "--fit",         "--view",         "--azimuth", "--elevation",    "--roll",
    "--zoom",       "--camera",      "--eye",          "--target",  "--up",           "--fov",
    "--near",       "--far",         "--orthographic", "--scalars", "--cmap",         "--range",
    "--log",        "--steps",       "--bar",          "--axes",    "--bounds",       "--occlusion",
    "--edl",        "--silhouettes", "--edges",        "--script",  "--screenshots",  "--target-ms",
    "--lights",     "--tone",        "--exposure"};

/// Options that go with a switch of the window, and mean nothing without.
struct Dependent {
  std::string_view option;
  bool (*wanted)(const MeshSettings&);
};
constexpr Dependent kDependent[] = {
    {"--light", [](const MeshSettings& s) { return s.lights.empty(); }},
    {"--environment-behind", [](const MeshSettings& s) { return s.lights.empty(); }},
    {"--occlusion-radius", [](const MeshSettings& s) { return s.notes.occlusion; }},
    {"--occlusion-strength", [](const MeshSettings& s) { return s.notes.occlusion; }},
    {"--edl-strength", [](const MeshSettings& s) { return s.notes.dome; }},
    {"--edge-angle", [](const MeshSettings& s) { return s.notes.edges; }},
    {"--edge-width", [](const MeshSettings& s) { return s.notes.edges; }},
    {"--symmetric", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--categories", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--below", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--above", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--nan-color", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--scalar-opacity", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--isolines", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--isoline-color", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--isoline-width", [](const MeshSettings& s) { return !s.notes.scalars.name.empty(); }},
    {"--bar-unit", [](const MeshSettings& s) { return s.notes.scalars.bar(); }},
};

bool is_repeated(const std::string& option, const MeshSettings& s) {
  if (std::ranges::find(kSaid, option) != std::end(kSaid)) return false;
  const auto found = std::ranges::find(kDependent, option, &Dependent::option);
  return found == std::end(kDependent) || found->wanted(s);
}

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", v);
  // The shortest that is the same number.
  for (int digits = 1; digits < 17; ++digits) {
    char shorter[40];
    std::snprintf(shorter, sizeof shorter, "%.*g", digits, v);
    if (std::stod(shorter) == v) return shorter;
  }
  return text;
}
std::string numbers(const Vec3d& v) {
  return number(v.x) + "," + number(v.y) + "," + number(v.z);
}
double degrees(float rad) {
  return static_cast<double>(rad) / (std::numbers::pi / 180);
}

/// As one word of a shell.
std::string quoted(const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_./,:=@%+-").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? "'\\''" : std::string(1, c);
  return all + "'";
}

std::string hex(Vec4 c) {
  const auto byte = [](float v) {
    return static_cast<unsigned>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255));
  };
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x%02x", byte(c.x), byte(c.y), byte(c.z), byte(c.w));
  return text;
}

class Words {
 public:
  Words& operator()(const std::string& option) {
    all_ += (all_.empty() ? "" : " ") + option;
    return *this;
  }
  Words& operator()(const std::string& option, const std::string& text) {
    return (*this)(option)(quoted(text));
  }
  [[nodiscard]] std::string take() { return std::move(all_); }

 private:
  std::string all_;
};

void say_camera(Words& say, const Camera& c) {
  say("--eye", numbers(c.eye))("--target", numbers(c.target))("--up", numbers(c.up));
  if (c.orthographic)
    say("--orthographic", number(static_cast<double>(c.orthographic_height)));
  else
    say("--fov", number(degrees(c.fov_rad)));
  say("--near", number(static_cast<double>(c.near_plane)));
  say("--far", std::isfinite(c.far_plane) ? number(static_cast<double>(c.far_plane)) : "inf");
}

void say_scalars(Words& say, const MeshSettings& s) {
  const ScalarOptions& o = s.notes.scalars;
  if (o.name.empty()) return;
  say("--scalars", o.name)("--cmap", s.map);
  if (o.mapping.range)
    say("--range", number(o.mapping.range->low) + "," + number(o.mapping.range->high));
  if (o.mapping.logarithmic) say("--log");
  if (o.mapping.steps != 0) say("--steps", std::to_string(o.mapping.steps));
  if (o.bar()) say("--bar", *o.bar_title);
}

void say_notes(Words& say, const AnnotationOptions& a) {
  const std::pair<const char*, bool> flags[] = {
      {"--axes", a.axes}, {"--bounds", a.bounds},           {"--occlusion", a.occlusion},
      {"--edl", a.dome},  {"--silhouettes", a.silhouettes}, {"--edges", a.edges}};
  for (const auto& [option, on] : flags)
    if (on) say(option);
}

std::string transparency_name(const TransparencyOptions& t) {
  const std::string name = transparency_names()[static_cast<std::size_t>(t.method)];
  return t.method == Transparency::filter ? name + ":" + std::to_string(t.filter) : name;
}

std::string tone_name(Tone tone) {
  return tone_names()[static_cast<std::size_t>(tone)];
}

/// As --lights has it; empty: what --light says, or nothing.
std::string lights_name(const ShownPicture& shown) {
  if (!shown.settings.lights.empty()) return shown.settings.lights;
  bool said = false;
  for (const Parser::Given& g : shown.arguments.given) {
    // A file that was opened since need not have any.
    if (g.name == "--lights" && g.texts.front() == "file" && shown.settings.file_lights.empty())
      return "";
    if (g.name == "--lights") return g.texts.front();
    said |= g.name == "--light";
  }
  // What the look has taken.
  return said || shown.settings.render.lights.empty() ? "" : "studio";
}

std::string plane_text(const ClipPlane& p) {
  return numbers(p.normal) + "," + number(p.offset);
}

// Python.

std::string literal(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return all + "\"";
}
std::string tuple(const Vec3d& v) {
  return "(" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")";
}

std::string python_camera(const Camera& c) {
  std::string all = c.orthographic ? "rr.Camera.orthographic(" : "rr.Camera.look_at(";
  all += tuple(c.eye) + ", " + tuple(c.target) + ", " + tuple(c.up) + ", ";
  all += c.orthographic ? "height=" + number(static_cast<double>(c.orthographic_height))
                        : "fov=" + number(degrees(c.fov_rad));
  all += ", near=" + number(static_cast<double>(c.near_plane));
  if (std::isfinite(c.far_plane))
    all += ", far=" + number(static_cast<double>(c.far_plane));
  else if (c.orthographic)
    all += ", far=float(\"inf\")";
  return all + ")";
}

/// Options that the window repeats and Python has words for.
constexpr std::string_view kPythonHas[] = {
    "--clip-plane",    "--crease",     "--cull",           "--environment-behind",
    "--title",         "--caption",    "--text-scale",     "--occlusion-radius",
    "--edl-strength",  "--edge-angle", "--edge-width",     "--occlusion-strength",
    "--symmetric",     "--categories", "--below",          "--above",
    "--nan-color",     "--isolines",   "--scalar-opacity", "--isoline-color",
    "--isoline-width", "--bar-unit"};

/// What Python's render has no word for here.
std::string without_words(const ShownPicture& shown) {
  const MeshSettings& s = shown.settings;
  std::string all;
  const auto add = [&](const std::string& option) { all += (all.empty() ? "" : ", ") + option; };
  for (const Parser::Given& g : shown.arguments.given)
    if (std::ranges::find(kPythonHas, g.name) == std::end(kPythonHas) && is_repeated(g.name, s))
      add(g.name);
  if (lights_name(shown) == "file") add("--lights file");
  const ScalarOptions& o = s.notes.scalars;
  if (!o.name.empty() && o.isoline_count != 0) add("--isolines " + std::to_string(o.isoline_count));
  if (!o.name.empty() && o.nan_given && o.bar()) add("--nan-color in the bar");
  for (const std::string& input : shown.arguments.inputs)
    if (input.starts_with("builtin:") || input.find('@') != std::string::npos || input == "-")
      add(input);
  return all;
}

std::string joined(const std::vector<std::string>& items) {
  std::string all;
  for (const std::string& item : items) all += (all.empty() ? "" : ", ") + item;
  return all;
}
std::string listed(const std::vector<std::string>& items) {
  return "[" + joined(items) + "]";
}
std::string listed(const std::vector<double>& values) {
  std::vector<std::string> items;
  for (const double v : values) items.push_back(number(v));
  return listed(items);
}

/// What stands behind `cmap=`.
std::string python_mapping(const MeshSettings& s) {
  const ScalarMapping& m = s.notes.scalars.mapping;
  std::vector<std::string> colors;
  if (s.map.find('#') != std::string::npos)
    for (const Vec4& c : m.map.colors) colors.push_back(literal(hex(c)));
  std::vector<std::string> said{colors.empty() ? literal(s.map) : listed(colors)};
  if (m.range) said.push_back("(" + number(m.range->low) + ", " + number(m.range->high) + ")");
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
    opacity.push_back("(" + number(o.value) + ", " + number(static_cast<double>(o.opacity)) + ")");
  if (!opacity.empty()) said.push_back("opacity=" + listed(opacity));
  if (!m.isolines.empty()) {
    said.push_back("isolines=" + listed(m.isolines));
    said.push_back("isoline_color=" + literal(hex(m.isoline_color)));
    said.push_back("isoline_width=" + number(static_cast<double>(m.isoline_px)));
  }
  return said.size() == 1 ? said.front() : "rr.ColorMapping(" + joined(said) + ")";
}

/// What stands behind `annotate=`; empty: nothing.
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
    notes.push_back("\"bar\": {\"title\": " + literal(*o.bar_title) +
                    ", \"unit\": " + literal(o.bar_unit) + "}");
  if (!a.words.title.empty()) notes.push_back("\"title\": " + literal(a.words.title));
  std::vector<std::string> captions;
  for (const std::string& c : a.words.captions) captions.push_back(literal(c));
  if (!captions.empty()) notes.push_back("\"captions\": " + listed(captions));
  if (!notes.empty() && a.words.scale_given)
    notes.push_back("\"text_scale\": " + number(a.words.scale));
  return joined(notes);
}

}  // namespace

family::Options MeshSettings::frame(int width, int height) const {
  family::Options options = render;
  options.width = width;
  options.height = height;
  if (!lights.empty()) {
    options.environment_behind = false;
    options.lights.clear();
    if (lights == "studio") options.lights = light_kit();
    if (lights == "headlight") options.lights = {headlight()};
    if (lights == "file") options.lights = file_lights;
  } else if (adds_file_lights) {
    options.lights.insert(options.lights.end(), file_lights.begin(), file_lights.end());
  }
  if (options.lights.empty()) options.shadows = false;
  for (int axis = 0; axis < 3; ++axis)
    if (const Section& section = sections[static_cast<std::size_t>(axis)]; section.on)
      options.clip_planes.push_back(section.plane(axis));
  return options;
}

std::string command_line(const ShownPicture& shown, const std::string& png) {
  const MeshSettings& s = shown.settings;
  const family::Options frame = s.frame(shown.width, shown.height);
  Words say;
  say("rastrum render");
  for (const std::string& input : shown.arguments.inputs) say(quoted(input));
  say("--look", "plain")("--size",
                         std::to_string(shown.width) + "x" + std::to_string(shown.height));
  say("--shader", std::string(name(frame.shader)));
  if (frame.background.w != 0) say("--background", hex(frame.background));
  if (frame.opacity != 1) say("--opacity", number(static_cast<double>(frame.opacity)));
  if (frame.transparency.method != Transparency::exact)
    say("--transparency", transparency_name(frame.transparency));
  say("--samples", std::to_string(frame.samples));
  if (frame.rasterizer != "auto") say("--rasterizer", frame.rasterizer);
  if (frame.visibility != "auto") say("--visibility", frame.visibility);
  if (const std::string lights = lights_name(shown); !lights.empty()) say("--lights", lights);
  if (frame.shadows) say("--shadows");
  if (frame.tone.tone != Tone::none) say("--tone", tone_name(frame.tone.tone));
  if (frame.tone.exposure_stops != 0)
    say("--exposure", number(static_cast<double>(frame.tone.exposure_stops)));
  say_scalars(say, s);
  say_notes(say, s.notes);
  for (int axis = 0; axis < 3; ++axis)
    if (const Section& section = s.sections[static_cast<std::size_t>(axis)]; section.on)
      say("--clip-plane", plane_text(section.plane(axis)));
  for (const Parser::Given& g : shown.arguments.given) {
    if (!is_repeated(g.name, s)) continue;
    if (g.texts.empty()) say(g.name);
    for (const std::string& text : g.texts) say(g.name, text);
  }
  say_camera(say, shown.camera);
  return say("-o", png).take() + "\n";
}

std::string python_lines(const ShownPicture& shown, const std::string& png) {
  const MeshSettings& s = shown.settings;
  const family::Options frame = s.frame(shown.width, shown.height);
  std::string all = "import rastrum as rr\n\n";
  if (const std::string missing = without_words(shown); !missing.empty())
    all += "# Not said here, for Python has no words for it: " + missing + "\n";
  std::vector<std::string> files;
  for (const std::string& input : shown.arguments.inputs) files.push_back(literal(input));
  all += "scene = rr.Scene(" + listed(files);
  if (shown.arguments.crease_given) all += ", crease=" + number(shown.arguments.normals.crease_deg);
  const ScalarOptions& o = s.notes.scalars;
  if (!o.name.empty()) all += ", scalars=" + literal(o.name) + ", cmap=" + python_mapping(s);
  all += ")\ncamera = " + python_camera(shown.camera) + "\n";
  all += "picture = rr.render(scene, camera, size=(" + std::to_string(shown.width) + ", " +
         std::to_string(shown.height) + "), shader=" + literal(std::string(name(frame.shader)));
  if (frame.background.w != 0) all += ", background=" + literal(hex(frame.background));
  if (frame.samples != 1) all += ", samples=" + std::to_string(frame.samples);
  if (frame.opacity != 1) all += ", opacity=" + number(static_cast<double>(frame.opacity));
  if (frame.transparency.method != Transparency::exact)
    all += ", transparency=" + literal(transparency_name(frame.transparency));
  if (frame.cull != Cull::none)
    all += std::string(", cull=") + (frame.cull == Cull::back ? "\"back\"" : "\"front\"");
  if (const std::string lights = lights_name(shown); !lights.empty() && lights != "file")
    all += ", lights=" + literal(lights);
  if (frame.shadows) all += ", shadows=True";
  if (frame.tone.tone != Tone::none) all += ", tone=" + literal(tone_name(frame.tone.tone));
  if (frame.tone.exposure_stops != 0)
    all += ", exposure=" + number(static_cast<double>(frame.tone.exposure_stops));
  if (!frame.clip_planes.empty()) {
    std::vector<std::string> planes;
    for (const ClipPlane& p : frame.clip_planes)
      planes.push_back("(" + number(p.normal.x) + ", " + number(p.normal.y) + ", " +
                       number(p.normal.z) + ", " + number(p.offset) + ")");
    all += ", clip_planes=" + listed(planes);
  }
  if (const std::string notes = python_notes(s.notes); !notes.empty())
    all += ", annotate={" + notes + "}";
  return all + ")\npicture.save(" + literal(png) + ")\n";
}

}  // namespace rastrum::cli::window
