// SPDX-License-Identifier: BSD-3-Clause
#include "ground_options.hpp"

#include <cstdio>

#include <rastrum/core/elementary.hpp>

namespace rastrum::cli {
namespace {

constexpr const char* kNumbers = "height";

/// The sun's light as a --light directional.
std::string direction_of(const terrain::Sun& sun) {
  const auto a = elementary::sin_cos(sun.azimuth_deg * kDegree),
             e = elementary::sin_cos(sun.elevation_deg * kDegree);
  char text[96];
  std::snprintf(text, sizeof text, "directional:%.3g,%.3g,%.3g", -a.sin * e.cos, -e.sin,
                a.cos * e.cos);
  return text;
}

void check_lights_of(const TerrainSceneArguments& a, const FrameOptions& frame,
                     const LightChoice& choice, const std::function<bool(const char*)>& given) {
  if (choice.of_files)
    throw UsageError("--lights",
                     "file: the lights of glTF files have places in their own scenes, not on a "
                     "terrain; give lights by --light");
  if (frame.environment_behind && !has_environment(frame.lights))
    throw UsageError("--environment-behind",
                     "needs an environment: --light environment:FILE, or sky or room for FILE");
  if (frame.environment_behind && given("--sky"))
    throw UsageError("--sky",
                     "has no effect, because --environment-behind shows the environment there; "
                     "leave one of them out, or give --fog a colour for far ground");
  if (frame.lights.empty()) {
    for (const char* const option : {"--tone", "--exposure"})
      if (given(option))
        throw UsageError(option,
                         "needs lights: give --lights or --light; the sun alone lights colours as "
                         "a display shows them");
    return;
  }
  if (given("--sun"))
    throw UsageError(
        "--sun",
        "--lights and --light take the sun's place: give the sun as one of them, --light " +
            direction_of(a.light.sun));
  if (a.dim_sky)
    throw UsageError("--dim-sky",
                     "the sky dims with the sun, but --lights and --light take the sun's place: "
                     "leave one of them out");
}

void check_numbers(GroundOptions& ground, const TerrainSceneArguments& a, bool has_colors,
                   const std::function<bool(const char*)>& given) {
  ScalarOptions& s = ground.heights;
  for (const char* const option : {"--isolines", "--isoline-color", "--isoline-width"})
    if (given(option))
      throw UsageError(option,
                       "draws on meshes only; on a terrain --steps shows where a height is");
  if (given("--scalar-opacity"))
    throw UsageError("--scalar-opacity", "has an effect on meshes only; ground is opaque");
  if (!s.name.empty() && s.name != kNumbers)
    throw UsageError("--scalars", "a terrain has no numbers but 'height', got '" + s.name + "'");
  if (s.given != nullptr || s.mapping.logarithmic || s.mapping.symmetric) s.name = kNumbers;
  check_scalars(s, has_colors);
  if (!s.name.empty() && a.input.color)
    throw UsageError(
        given("--cmap")      ? "--cmap"
        : s.given != nullptr ? s.given
                             : "--scalars",
        "colours the ground by its heights, but --color colours it, too: leave one of them out");
}

}  // namespace

void add_ground_options(Parser app, GroundOptions& ground) {
  add_scalar_options(app, ground.heights, NumbersOf::terrain);
  app = app.under("Words");
  app.add_flag("--axes", ground.axes,
               "draw the directions of x, height and y in the bottom left corner");
  app.add_flag(
      "--bounds", ground.bounds,
      "draw a box around the map with ticks and numbers: cells, and heights as the file has them");
}

void check_ground(GroundOptions& ground, const TerrainSceneArguments& a, const FrameOptions& frame,
                  const LightChoice& choice, bool has_colors,
                  const std::function<bool(const char*)>& given) {
  check_lights_of(a, frame, choice, given);
  check_numbers(ground, a, has_colors, given);
  const char* const drawn = ground.axes ? "--axes" : ground.bounds ? "--bounds" : nullptr;
  if (drawn == nullptr) return;
  if (!has_colors) throw UsageError(drawn, "needs a picture: give -o");
  if (a.options.projection != terrain::Projection::planar)
    throw UsageError(drawn, "needs --projection planar, where straight lines stay straight");
  if (ground.bounds && !a.input.height)
    throw UsageError("--bounds",
                     "a function has no ends to draw a box around; give a map by --height");
}

}  // namespace rastrum::cli
