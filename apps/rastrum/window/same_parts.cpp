// SPDX-License-Identifier: BSD-3-Clause
#include "same_parts.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace rastrum::cli::window {
namespace {

/// Options that the window states itself, or that are for windows alone.
constexpr std::string_view kSaid[] = {
    "--size",       "--shader",      "--background",   "--opacity", "--transparency", "--samples",
    "--rasterizer", "--visibility",  "--look",         "--device",  "--threads",      "--isa",
    "--shadows",    "--fit",         "--view",         "--azimuth", "--elevation",    "--roll",
    "--zoom",       "--camera",      "--eye",          "--target",  "--up",           "--fov",
    "--near",       "--far",         "--orthographic", "--scalars", "--cmap",         "--range",
    "--log",        "--steps",       "--bar",          "--axes",    "--bounds",       "--occlusion",
    "--edl",        "--silhouettes", "--edges",        "--script",  "--screenshots",  "--target-ms",
    "--lights",     "--tone",        "--exposure"};

/// Options that depend on a switch of the window.
struct Dependent {
  std::string_view option;
  bool (*wanted)(const MeshSettings&);
};
bool shows_numbers(const MeshSettings& s) {
  return !s.notes.scalars.name.empty();
}
constexpr Dependent kDependent[] = {
    {"--light", [](const MeshSettings& s) { return s.lights.empty(); }},
    {"--environment-behind", [](const MeshSettings& s) { return s.lights.empty(); }},
    {"--occlusion-radius", [](const MeshSettings& s) { return s.notes.occlusion; }},
    {"--occlusion-strength", [](const MeshSettings& s) { return s.notes.occlusion; }},
    {"--edl-strength", [](const MeshSettings& s) { return s.notes.dome; }},
    {"--edge-angle", [](const MeshSettings& s) { return s.notes.edges; }},
    {"--edge-width", [](const MeshSettings& s) { return s.notes.edges; }},
    {"--symmetric", shows_numbers},
    {"--categories", shows_numbers},
    {"--below", shows_numbers},
    {"--above", shows_numbers},
    {"--nan-color", shows_numbers},
    {"--scalar-opacity", shows_numbers},
    {"--isolines", shows_numbers},
    {"--isoline-color", shows_numbers},
    {"--isoline-width", shows_numbers},
    {"--bar-unit", [](const MeshSettings& s) { return s.notes.scalars.bar(); }},
};

}  // namespace

bool is_repeated(const std::string& option, const MeshSettings& s) {
  if (std::ranges::find(kSaid, option) != std::end(kSaid)) return false;
  const auto found = std::ranges::find(kDependent, option, &Dependent::option);
  return found == std::end(kDependent) || found->wanted(s);
}

void say_given(Words& say, const Parser::Given& given) {
  if (given.texts.empty()) say(given.name);
  for (const std::string& text : given.texts) say(given.name, text);
}

void say_tone(Words& say, const ToneMapping& tone) {
  if (tone.tone != Tone::none) say("--tone", word_of(kTones, tone.tone));
  if (tone.exposure_stops != 0) say("--exposure", number(static_cast<double>(tone.exposure_stops)));
}

void say_tone(Call& say, const ToneMapping& tone) {
  if (tone.tone != Tone::none) say("tone", literal(word_of(kTones, tone.tone)));
  if (tone.exposure_stops != 0) say("exposure", number(static_cast<double>(tone.exposure_stops)));
}

std::string lights_name(const ShownPicture& shown) {
  const MeshSettings& s = shown.settings;
  if (!s.lights.empty()) return s.lights;
  std::string name = said(shown.arguments.given, "--lights", "");
  // A file opened later may have none.
  if (name == "file" && s.file_lights.empty()) return "";
  if (!name.empty()) return name;
  const bool by_light = std::ranges::any_of(
      shown.arguments.given, [](const Parser::Given& g) { return g.name == "--light"; });
  // Without such an option lights come from the look.
  return by_light || s.render.lights.empty() ? "" : "studio";
}

}  // namespace rastrum::cli::window
