// SPDX-License-Identifier: BSD-3-Clause
#include "same_picture.hpp"

#include <cmath>
#include <utility>

#include "picture_text.hpp"
#include "same_parts.hpp"

namespace rastrum::cli::window {
namespace {

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

std::string plane_text(const ClipPlane& p) {
  return numbers(p.normal) + "," + number(p.offset);
}

}  // namespace

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
  say_tone(say, frame.tone);
  say_scalars(say, s);
  say_notes(say, s.notes);
  for (const ClipPlane& plane : s.cuts()) say("--clip-plane", plane_text(plane));
  for (const Parser::Given& g : shown.arguments.given)
    if (is_repeated(g.name, s)) say_given(say, g);
  say_camera(say, shown.camera);
  return say("-o", png).take() + "\n";
}

}  // namespace rastrum::cli::window
