#include "same_parts.hpp"

#include <algorithm>
#include <iterator>
#include <ranges>
#include <string_view>

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

}  // namespace

bool is_repeated(const std::string& option, const MeshSettings& s) {
  if (std::ranges::find(kSaid, option) != std::end(kSaid)) return false;
  const auto found = std::ranges::find(kDependent, option, &Dependent::option);
  return found == std::end(kDependent) || found->wanted(s);
}

std::string tone_name(Tone tone) {
  return tone_names()[static_cast<std::size_t>(tone)];
}

std::string lights_said(const std::string& chosen, std::span<const Parser::Given> given) {
  if (!chosen.empty()) return chosen;
  const auto at = std::ranges::find(given, "--lights", &Parser::Given::name);
  return at == given.end() ? "" : at->texts.front();
}

std::string lights_name(const ShownPicture& shown) {
  const MeshSettings& s = shown.settings;
  const std::string said = lights_said(s.lights, shown.arguments.given);
  // A file that was opened since need not have any.
  if (said == "file" && s.lights.empty() && s.file_lights.empty()) return "";
  if (!said.empty()) return said;
  const bool by_light = std::ranges::any_of(
      shown.arguments.given, [](const Parser::Given& g) { return g.name == "--light"; });
  // Lights without any such option come from the look.
  return by_light || s.render.lights.empty() ? "" : "studio";
}

}  // namespace rastrum::cli::window
