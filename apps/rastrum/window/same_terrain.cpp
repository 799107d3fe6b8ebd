// SPDX-License-Identifier: BSD-3-Clause
#include "same_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "parse/light_options.hpp"
#include "picture_text.hpp"
#include "same_parts.hpp"

namespace rastrum::cli::window {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Degrees from which exactly `rad` is made, if there are any.
std::optional<double> exact_degrees(double rad) {
  const double near = rad / kRadians;
  if (near * kRadians == rad) return near;
  constexpr int kSteps = 4;
  for (const double end :
       {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    double d = near;
    for (int i = 0; i < kSteps; ++i) {
      d = std::nextafter(d, end);
      if (d * kRadians == rad) return d;
    }
  }
  return std::nullopt;
}

double degrees_of(double rad) {
  return exact_degrees(rad).value_or(rad / kRadians);
}

std::string hex(Rgba8 c) {
  return window::hex({static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255,
                      static_cast<float>(c.b) / 255, 1})
      .substr(0, 7);
}

/// The original program has its own field of view.
double fov_of(const ShownTerrain& t) {
  return t.look.classic ? t.look.fov_rad : t.pose.fov_rad;
}

void say_place(Words& say, const TerrainPose& pose) {
  const terrain::TerrainCamera& c = pose.camera;
  say("--position", number(c.x) + "," + number(c.y))("--altitude", number(c.altitude));
  say("--angle", number(degrees_of(c.angle_rad)))("--horizon", number(c.horizon_px));
  if (c.roll_rad != 0) say("--roll", number(degrees_of(c.roll_rad)));
}

void say_look(Words& say, const ShownTerrain& t) {
  const TerrainLook& o = t.look;
  const TerrainLook usual;
  say("--distance", number(t.pose.distance));
  if (fov_of(t) != usual.fov_rad) say("--fov", number(degrees_of(fov_of(t))));
  if (o.scale_px != 0) say("--scale", number(o.scale_px));
  if (o.step != 0 && !o.classic) say("--step", number(o.step));
  if (o.dz != usual.dz) say("--dz", number(o.dz));
  if (o.classic)
    say("--classic");
  else
    say("--filter", word_of(kFilters, o.filter));
  if (o.projection == terrain::Projection::cylindrical) say("--projection", "cylindrical");
  const bool by_sun = t.frame.lights.empty();
  if (by_sun ? o.sky != usual.sky || !t.sky_dims
             : o.sky != usual.sky && !t.frame.environment_behind) {
    say("--sky", hex(o.sky));
    if (by_sun && t.sky_dims && !o.classic) say("--dim-sky");
  }
  if (o.fog.density != 0) {
    std::string fog = number(o.fog.density) + "," + number(o.fog.start);
    if (o.fog.color) fog += "," + hex(*o.fog.color);
    say("--fog", fog);
  }
  if (o.ground_clearance) say("--clearance", number(*o.ground_clearance));
}

void say_light(Words& say, const ShownTerrain& t) {
  const terrain::Light usual;
  const terrain::Sun& sun = t.pose.sun;
  if (t.frame.lights.empty() &&
      (sun.azimuth_deg != usual.sun.azimuth_deg || sun.elevation_deg != usual.sun.elevation_deg))
    say("--sun", number(sun.azimuth_deg) + "," + number(sun.elevation_deg));
  if (t.light.shadows != usual.shadows) say("--shadows", word_of(kShadows, t.light.shadows));
  if (t.light.sun_radius_deg != usual.sun_radius_deg)
    say("--sun-radius", number(t.light.sun_radius_deg));
}

/// Options of the ground that are repeated as given.
constexpr std::string_view kNumberOptions[] = {
    "--scalars",    "--cmap",  "--range", "--log",       "--symmetric", "--steps",
    "--categories", "--below", "--above", "--nan-color", "--bar",       "--bar-unit"};

bool shows_numbers(const ShownTerrain& t) {
  return !t.shown.ground.heights.name.empty() && !t.input.color;
}

void say_ground(Words& say, const ShownTerrain& t) {
  if (!t.lights.empty() && t.lights != "sun") say("--lights", t.lights);
  for (const Parser::Given& g : t.shown.given) {
    const bool repeated =
        (t.lights.empty() && (g.name == "--light" || g.name == "--lights")) ||
        (shows_numbers(t) && std::ranges::find(kNumberOptions, g.name) != std::end(kNumberOptions));
    if (repeated) say_given(say, g);
  }
  say_tone(say, t.frame.tone);
  if (t.frame.environment_behind) say("--environment-behind");
  if (t.shown.ground.axes) say("--axes");
  if (t.shown.ground.bounds && t.input.height) say("--bounds");
}

/// A comment about what neither the command line nor Python can express.
std::string without_words(const ShownTerrain& t) {
  std::string all;
  const terrain::TerrainCamera& c = t.pose.camera;
  for (const double rad : {c.angle_rad, c.roll_rad, fov_of(t)})
    if (!exact_degrees(rad))
      all +=
          "# No number of degrees gives one of the angles exactly; the nearest one stands here.\n";
  if (t.input.height && !t.input.height_scale && t.input.classic_scale != t.look.classic)
    all +=
        "# The heights have the scale with which they were read, before the classic picture was "
        "switched.\n";
  return all;
}

}  // namespace

double angle_in_degrees(double rad) {
  return exact_degrees(rad) ? rad : rad / kRadians * kRadians;
}

TerrainPose sayable(TerrainPose pose) {
  for (double* const angle : {&pose.camera.angle_rad, &pose.camera.roll_rad, &pose.fov_rad})
    *angle = angle_in_degrees(*angle);
  return pose;
}

std::string terrain_command_line(const ShownTerrain& t, const std::string& png) {
  Words say;
  say("rastrum terrain");
  if (t.input.height) say("--height", t.input.height->string());
  if (t.input.color) say("--color", t.input.color->string());
  if (!t.input.height) say("--function", t.input.function);
  if (t.input.raw_size.width > 0)
    say("--height-size",
        std::to_string(t.input.raw_size.width) + "x" + std::to_string(t.input.raw_size.height));
  if (t.input.height_scale) say("--height-scale", number(*t.input.height_scale));
  if (t.input.raw_size.big_endian) say("--height-order", "big");
  if (t.look.tiling != suited_tiling(t.input)) say("--tile", word_of(kTilings, t.look.tiling));
  say("--size", std::to_string(t.width) + "x" + std::to_string(t.height));
  say_place(say, t.pose);
  say_look(say, t);
  say_light(say, t);
  say_ground(say, t);
  return without_words(t) + say("-o", png).take() + "\n";
}

std::string terrain_python(const ShownTerrain& t, const std::string& png) {
  const TerrainLook& o = t.look;
  const TerrainLook usual;
  const terrain::Light usual_light;
  std::string all = "import rastrum as rr\n\n" + without_words(t);
  std::string missing;
  const auto lacks = [&](const char* option, bool said) {
    if (said) missing += (missing.empty() ? "" : ", ") + std::string(option);
  };
  lacks("--function", !t.input.height);
  lacks("--height-size", t.input.raw_size.width > 0);
  lacks("--height-order", t.input.raw_size.big_endian);
  lacks("--classic", o.classic);
  lacks("--step", o.step != 0 && !o.classic);
  lacks("--dz", o.dz != usual.dz);
  if (!missing.empty())
    all += "# Left out here, since the Python package does not have it: " + missing + "\n";
  if (t.input.height && !t.input.height_scale)
    all +=
        "# A file that does not say how high its unit is needs height_scale=, as the program "
        "prints it.\n";
  Call map("rr.Terrain");
  map(literal(t.input.height ? t.input.height->string() : t.input.function));
  if (t.input.color) map(literal(t.input.color->string()));
  if (t.input.height_scale) map("height_scale", number(*t.input.height_scale));
  const bool by_sun = t.frame.lights.empty();
  if (by_sun)
    map("sun", in_brackets({number(t.pose.sun.azimuth_deg), number(t.pose.sun.elevation_deg)}));
  else
    map("lights", python_lights(t.lights.empty() ? said(t.shown.given, "--lights", "") : t.lights,
                                t.lights.empty(), t.frame.lights, t.shown.given));
  say_tone(map, t.frame.tone);
  if (t.light.shadows != usual_light.shadows)
    map("shadows", literal(word_of(kShadows, t.light.shadows)));
  if (t.light.sun_radius_deg != usual_light.sun_radius_deg)
    map("sun_radius", number(t.light.sun_radius_deg));
  const GroundOptions& ground = t.shown.ground;
  if (shows_numbers(t))
    map("cmap", python_mapping(said(t.shown.given, "--cmap", "viridis"), ground.heights));
  map("filter", literal(word_of(kFilters, o.filter)));
  if (o.tiling != suited_tiling(t.input)) map("tiling", literal(word_of(kTilings, o.tiling)));
  const terrain::TerrainCamera& c = t.pose.camera;
  Call frame("terrain.render");
  frame(in_brackets({number(c.x), number(c.y)}));
  frame("altitude", number(c.altitude));
  frame("angle", number(degrees_of(c.angle_rad)));
  frame("horizon", number(c.horizon_px));
  if (c.roll_rad != 0) frame("roll", number(degrees_of(c.roll_rad)));
  if (o.ground_clearance) frame("clearance", number(*o.ground_clearance));
  frame("size", in_brackets({number(t.width), number(t.height)}));
  frame("distance", number(t.pose.distance));
  frame("fov", number(degrees_of(fov_of(t))));
  if (o.scale_px != 0) frame("scale", number(o.scale_px));
  if (o.projection == terrain::Projection::cylindrical) frame("projection", "\"cylindrical\"");
  if (by_sun && (o.sky != usual.sky || !t.sky_dims))
    frame("sky", literal(hex(sky_of(o, t.pose.sun, t.sky_dims))));
  if (!by_sun && o.sky != usual.sky && !t.frame.environment_behind)
    frame("sky", literal(hex(o.sky)));
  if (t.frame.environment_behind) frame("environment_behind", "True");
  AnnotationOptions notes;
  notes.axes = ground.axes;
  notes.bounds = ground.bounds && t.input.height;
  if (shows_numbers(t)) notes.scalars = ground.heights;
  if (notes.any()) frame("annotate", python_notes(notes));
  if (o.fog.density != 0) {
    std::vector<std::string> fog{number(o.fog.density), number(o.fog.start)};
    if (o.fog.color) fog.push_back(literal(hex(*o.fog.color)));
    frame("fog", in_brackets(fog));
  }
  return all + "terrain = " + map.text() + "\npicture = " + frame.text() + "\npicture.save(" +
         literal(png) + ")\n";
}

}  // namespace rastrum::cli::window
