// SPDX-License-Identifier: BSD-3-Clause
#include "light_options.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include <rastrum/core/srgb.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

namespace rastrum::cli {
namespace {

constexpr const char* kOption = "--light";

Vec3 linear_light(Vec4 display) {
  const auto channel = [](float v) {
    return static_cast<float>(linear_from_srgb(static_cast<double>(v)));
  };
  return {channel(display.x), channel(display.y), channel(display.z)};
}

float number(const std::string& text) {
  return static_cast<float>(parse_number(kOption, text));
}
float radians(const std::string& text) {
  return static_cast<float>(parse_number(kOption, text) * kDegree);
}

/// A light of a kind with defaults only.
Light light_of(const std::string& kind) {
  Light light;
  if (kind == "ambient") {
    light.kind = AmbientLight{};
  } else if (kind == "hemisphere") {
    light.kind = HemisphereLight{};
  } else if (kind == "directional") {
    light.kind = DirectionalLight{};
  } else if (kind == "point") {
    light.kind = PointLight{};
  } else if (kind == "spot") {
    light.kind = SpotLight{};
  } else if (kind == "headlight") {
    light = headlight();
  } else if (kind == "environment") {
    light.kind = EnvironmentLight{};
  } else {
    throw UsageError(kOption,
                     "expected ambient, hemisphere, directional, point, spot, headlight or "
                     "environment, then its values, as in point:2,3,4:intensity=9, got '" +
                         kind + "'");
  }
  return light;
}

Environment environment_of(const std::string& text) {
  try {
    if (text == "sky") return Environment(builtin_environment(BuiltinEnvironment::sky));
    if (text == "room") return Environment(builtin_environment(BuiltinEnvironment::room));
    return Environment(io::read_light(text));
  } catch (const Error& e) {
    const std::string what = e.what();
    throw UsageError(kOption, !what.starts_with(text) ? text + ": " + what : what);
  }
}

void set_place(Light& light, const std::string& text) {
  if (auto* const e = std::get_if<EnvironmentLight>(&light.kind)) {
    e->picture = environment_of(text);
    return;
  }
  const Vec3d v = parse_vec3(kOption, text);
  if (auto* const h = std::get_if<HemisphereLight>(&light.kind))
    h->up = Vec3(v);
  else if (auto* const d = std::get_if<DirectionalLight>(&light.kind))
    d->direction = Vec3(v);
  else if (auto* const p = std::get_if<PointLight>(&light.kind))
    p->position = v;
  else if (auto* const s = std::get_if<SpotLight>(&light.kind))
    s->position = v;
  else
    throw UsageError(kOption, "an ambient light has no place: '" + text + "'");
}

/// Returns whether the light has such a value.
bool set_value(Light& light, const std::string& name, const std::string& value) {
  auto* const spot = std::get_if<SpotLight>(&light.kind);
  auto* const point = std::get_if<PointLight>(&light.kind);
  auto* const hemisphere = std::get_if<HemisphereLight>(&light.kind);
  auto* const environment = std::get_if<EnvironmentLight>(&light.kind);
  if (name == "intensity") {
    light.intensity = number(value);
  } else if (name == "color") {
    light.color = linear_light(parse_color(kOption, value));
  } else if (name == "of") {
    if (value != "camera" && value != "world")
      throw UsageError(kOption, "of= is camera or world, got '" + value + "'");
    light.of_camera = value == "camera";
  } else if (name == "below" && hemisphere != nullptr) {
    hemisphere->below = linear_light(parse_color(kOption, value));
  } else if (name == "range" && (point != nullptr || spot != nullptr)) {
    (point != nullptr ? point->range : spot->range) = number(value);
  } else if (name == "towards" && spot != nullptr) {
    spot->direction = Vec3(parse_vec3(kOption, value));
  } else if (name == "inner" && spot != nullptr) {
    spot->inner_rad = radians(value);
  } else if (name == "outer" && spot != nullptr) {
    spot->outer_rad = radians(value);
  } else if (name == "up" && environment != nullptr) {
    environment->up = Vec3(parse_vec3(kOption, value));
  } else if (name == "turn" && environment != nullptr) {
    environment->turn_rad = radians(value);
  } else {
    return false;
  }
  return true;
}

}  // namespace

Light parse_light(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text, ":");
  Light light = light_of(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::size_t equal = parts[i].find('=');
    if (equal == std::string::npos && i == 1)
      set_place(light, parts[i]);
    else if (equal == std::string::npos ||
             !set_value(light, parts[i].substr(0, equal), parts[i].substr(equal + 1)))
      throw UsageError(
          kOption, "a light of kind " + parts.front() + " has no '" + parts[i] +
                       "'; there are intensity=, color=, of=, below= (hemisphere), range= (point, "
                       "spot), towards=, inner=, outer= (spot), turn=, up= (environment)");
  }
  try {
    check_lights({&light, 1});
  } catch (const Error& e) {
    throw UsageError(kOption, std::string(e.what()) + ": '" + text + "'");
  }
  return light;
}

bool has_environment(const std::vector<Light>& lights) {
  return std::ranges::any_of(lights, [](const Light& light) {
    return std::holds_alternative<EnvironmentLight>(light.kind);
  });
}

std::string said(std::span<const Parser::Given> given, std::string_view option,
                 const std::string& otherwise) {
  const auto found = std::ranges::find(given, option, &Parser::Given::name);
  return found == given.end() ? otherwise : found->texts.back();
}

void say_again(std::vector<Parser::Given> options, const LightChoice& lights,
               std::vector<Parser::Given>& given) {
  std::erase_if(given, [&](const Parser::Given& old) {
    return (lights.given && (old.name == "--light" || old.name == "--lights")) ||
           std::ranges::find(options, old.name, &Parser::Given::name) != options.end();
  });
  std::ranges::move(options, std::back_inserter(given));
}

void add_file_lights(const Scene& scene, std::vector<Light>& lights) {
  if (scene.lights.empty()) throw UsageError("--lights", "the inputs have no lights of their own");
  lights.insert(lights.end(), scene.lights.begin(), scene.lights.end());
  if (lights.size() > kMaxLights)
    throw UsageError("--lights", std::to_string(lights.size()) + " lights are given, and at most " +
                                     std::to_string(kMaxLights) + " are possible");
}

namespace {

/// Texts of --help for options of both meshes and ground.
struct LightHelp {
  const char *lights, *instead, *tone, *exposure;
};
constexpr LightHelp kOfMeshes{
    "lights of the shaders lambert, phong, material and classic. default: each shader's fixed "
    "light; "
    "headlight: one at the viewer; studio: key, fill, back and head light; file: the lights of "
    "glTF files (without this option: studio where only -o and no --shader is asked for, "
    "docs/light.md; else default)",
    "add a light, in place of the fixed one or beside --lights: ", "for --shader material: ",
    "for --shader material: double the light so many times (default: 0)"};
constexpr LightHelp kOfGround{
    "lights of ground and meshes in the sun's place. headlight: one at the viewer; studio: key, "
    "fill, back and head light; default: the sun (without this option: default)",
    "add a light, in the sun's place or beside --lights; x is east, y the height and z south: ",
    "for --light and --lights, whose light becomes linear, and whose meshes the shader material "
    "draws: ",
    "for --light and --lights: double the light so many times (default: 0)"};

void add_lights(Parser app, FrameOptions& frame, LightChoice& choice, const LightHelp& help) {
  std::vector<Light>& lights = frame.lights;
  add(app, "--lights", "NAME", help.lights, [&lights, &choice](const std::string& s) {
    choice.given = true;
    if (s == "headlight")
      lights.push_back(headlight());
    else if (s == "studio")
      std::ranges::copy(light_kit(), std::back_inserter(lights));
    else if (s == "file")
      choice.of_files = true;
    else if (s != "default")
      throw UsageError("--lights", "expected default, headlight, studio or file, got '" + s + "'");
  });
  app.add_repeated("--light", "KIND:X,Y,Z:...",
                   std::string(help.instead) +
                       "ambient, hemisphere:UP, directional:DIRECTION, point:PLACE, "
                       "spot:PLACE:towards=DIRECTION, headlight, environment:FILE (.hdr, .exr, "
                       ".png, .jpg; or sky, room), with :intensity=I:color=COLOUR:of=camera "
                       "(docs/light.md); may be repeated",
                   [&lights, &choice](const std::string& s) {
                     choice.given = true;
                     if (lights.size() >= kMaxLights)
                       throw UsageError("--light", "at most 256 lights are possible");
                     lights.push_back(parse_light(s));
                   });
  add(app, "--tone", "NAME",
      std::string(help.tone) +
          "how light above 1 is shown: none cuts it off, reinhard, aces, neutral (Khronos PBR "
          "Neutral) (default: none)",
      [&frame](const std::string& s) {
        for (const auto& [word, tone] : kTones)
          if (s == word) {
            frame.tone.tone = tone;
            return;
          }
        throw UsageError("--tone", "expected none, reinhard, aces or neutral, got '" + s + "'");
      });
  add(app, "--exposure", "STOPS", help.exposure, [&frame](const std::string& s) {
    frame.tone.exposure_stops = static_cast<float>(parse_number("--exposure", s));
    if (!(frame.tone.exposure_stops >= -32 && frame.tone.exposure_stops <= 32))
      throw UsageError("--exposure", "must lie in -32 to 32, got '" + s + "'");
  });
  app.add_flag("--environment-behind", frame.environment_behind,
               "show the environment of --light where nothing else is seen");
}

}  // namespace

void add_ground_lights(Parser app, FrameOptions& frame, LightChoice& choice) {
  add_lights(app.under("Light"), frame, choice, kOfGround);
}

void add_light_options(Parser app, FrameOptions& frame, LightChoice& choice) {
  add_lights(app, frame, choice, kOfMeshes);
  app.add_flag("--shadows", frame.shadows,
               "draw the shadows of the directional lights and spots of --lights and --light");
  add_number_that(
      app, "--shadow-size", "TEXELS",
      "largest width of a shadow map in texels, 64 to 8192 (default: the frame's size decides)",
      frame.shadow_size,
      [](double size) { return size >= 64 && size <= 8192 && size == std::floor(size); },
      "must be a whole number from 64 to 8192");
  add_number_that(app, "--shadow-distance", "D",
                  "how far from the eye --shadows are drawn (default: as far as the picture sees)",
                  frame.shadow_distance, is_above_zero, "must be greater than 0");
}

}  // namespace rastrum::cli
