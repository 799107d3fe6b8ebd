// SPDX-License-Identifier: BSD-3-Clause
#include "terrain_options.hpp"

#include <algorithm>
#include <ranges>
#include <string>
#include <vector>

#include <rastrum/family.hpp>

namespace rastrum::cli {
namespace {

std::vector<double> parse_numbers(const char* option, const std::string& text, std::size_t n,
                                  const char* wanted) {
  const std::vector<std::string> parts = parts_of(text, ",");
  std::vector<double> values;
  for (std::size_t i = 0; i < std::min(n, parts.size()); ++i)
    values.push_back(parse_number(option, parts[i]));
  if (parts.size() != n)
    throw UsageError(option, std::string("expected ") + wanted + ", got '" + text + "'");
  return values;
}

Rgba8 parse_rgb(const char* option, const std::string& text) {
  const Vec4 c = parse_color(option, text);
  const auto channel = [](float v) { return static_cast<std::uint8_t>(v * 255.0F + 0.5F); };
  return {channel(c.x), channel(c.y), channel(c.z), 255};
}

/// DENSITY[,START][,COLOUR]: a third part, or one that does not begin like a number, is a colour.
terrain::Fog parse_fog(const std::string& text) {
  terrain::Fog fog;
  std::string rest = text;
  const std::size_t last = rest.rfind(','), first = rest.find(',');
  if (last != std::string::npos &&
      (first != last || rest.find_first_of("0123456789.+-", last) != last + 1)) {
    fog.color = parse_rgb("--fog", rest.substr(last + 1));
    rest.resize(last);
  }
  const bool has_start = rest.find(',') != std::string::npos;
  const std::vector<double> v =
      parse_numbers("--fog", rest, has_start ? 2 : 1, "DENSITY[,START][,COLOUR]");
  fog.density = v[0];
  if (has_start) fog.start = v[1];
  return fog;
}

}  // namespace

void add_terrain_inputs(Parser app, TerrainSceneArguments& a) {
  app = app.under("Terrain");
  add(app, "--height", "FILE",
      "the height map: .png (8 or 16 bit, grey), .raw .bin .r16 (uint16), .npy, .dem (USGS), .tif "
      ".tiff",
      [&a](const std::string& s) { a.input.height = s; });
  add(app, "--color", "FILE",
      "the ground's colours, .png or .jpg of any size, stretched over the map (default: colours by "
      "height, with shaded slopes)",
      [&a](const std::string& s) { a.input.color = s; });
  add(app, "--function", "NAME|EXPR",
      joined(std::views::transform(terrain::named_functions(), &terrain::FunctionInfo::name)) +
          ", or a formula of x and y (in cells) such as '40*sin(x/30)*cos(y/50)'",
      [&a](const std::string& s) { a.input.function = s; });
  add(app, "--height-size", "WxH", "size of a raw height map in cells (default: a square)",
      [&a](const std::string& s) {
        const Size size = parse_size("--height-size", s);
        a.input.raw_size.width = size.width;
        a.input.raw_size.height = size.height;
      });
  add_choice(app, "--height-order", "NAME",
             "byte order of raw heights: little, big (default: little)",
             a.input.raw_size.big_endian, {{"little", false}, {"big", true}});
  add_number(app, "--height-scale", "S",
             "how many cells high a unit of the file is (default: for 8 bit 1; for .dem and .tif 1 "
             "/ cell size; else the relief becomes a twelfth of the map's side; with --classic 1, "
             "for 16 bit 1/257)",
             a.input.height_scale);
  add(app, "--tile", "NAME",
      "what lies beyond the map's edge: repeat, mirror, clamp, none (default: repeat; for .dem and "
      ".tif none)",
      [&a](const std::string& s) {
        a.tile_given = true;
        a.options.tiling = choose("--tile", s, kTilings);
      });
}

void add_terrain_camera(Parser app, TerrainSceneArguments& a) {
  app = app.under("Camera");
  add(app, "--position", "X,Y",
      "where the camera stands, in cells, x east and y south (default: half the map's width, 0.78 "
      "of its height)",
      [&a](const std::string& s) {
        const std::vector<double> v = parse_numbers("--position", s, 2, "X,Y");
        a.x = v[0];
        a.y = v[1];
      });
  add_number(app, "--altitude", "H",
             "height of the camera in cells (default: a tenth of the relief above the highest "
             "point; with --classic 78)",
             a.altitude);
  add_number(app, "--angle", "DEG", "direction of the view: 0 looks north, 90 west (default: 0)",
             a.angle_deg);
  add_number(app, "--horizon", "ROW",
             "row of the horizon, in pixels from the top; a smaller one looks down (default: a "
             "quarter of the picture; with --classic 100)",
             a.horizon_px);
  add_number(app, "--roll", "DEG", "turn the picture counter-clockwise (default: 0)", a.roll_deg);
  add_number(app, "--clearance", "H",
             "lift the camera to so many cells above the ground (default: do not lift it)",
             a.options.ground_clearance);
}

void add_terrain_picture(Parser app, TerrainSceneArguments& a) {
  app = app.under("Picture");
  terrain::TerrainOptions& o = a.options;
  add_size(app, o);
  add_number(app, "--distance", "D", "how far the picture sees, in cells (default: 800)",
             o.distance);
  add(app, "--fov", "DEG", "field of view across the picture's width (default: 90)",
      [&o](const std::string& s) { o.fov_rad = parse_number("--fov", s) * kDegree; });
  add_number(
      app, "--scale", "PX",
      "how many rows a height of 1 takes at distance 1 (default: as many as columns in the middle)",
      o.scale_px);
  add_number_that(
      app, "--step", "S",
      "cells from the first sample along the view to the next; a smaller step is finer near the "
      "camera (default: for bilinear each step is as long as a pixel is high there; else 1)",
      o.step, is_above_zero, "must be greater than 0");
  add(app, "--dz", "G", "each further step is longer by this (default: 0.005 with a --step of 1)",
      [&o](const std::string& s) {
        o.dz = parse_number("--dz", s);
        if (o.step == 0) o.step = 1;
      });
  add(app, "--filter", "NAME",
      "how the map is sampled: none, bilinear, mip (default: bilinear; with --classic none)",
      [&a](const std::string& s) {
        a.filter_given = true;
        a.options.filter = choose("--filter", s, kFilters);
      });
  add_choice(app, "--projection", "NAME",
             "planar, or cylindrical, which stretches nothing at wide angles, up to 360 degrees "
             "(default: planar)",
             o.projection, kProjections);
  add(app, "--sky", "COLOUR",
      "colour of the sky (default: #9090e0, which dims with a sun below 30 degrees)",
      [&a](const std::string& s) {
        a.options.sky = parse_rgb("--sky", s);
        a.sky_dims = false;
      });
  app.add_flag("--dim-sky", a.dim_sky, "dim the colour of --sky, too, if the sun is low");
  add(app, "--fog", "DENSITY[,START][,COLOUR]",
      "fog of this density a cell, from START cells on, of this colour (default: no fog; START 0; "
      "the sky's colour)",
      [&o](const std::string& s) { o.fog = parse_fog(s); });
  app.add_flag("--classic", o.classic,
               "draw the original program's picture bit for bit: 90 degrees, scale 240, 10 above "
               "the ground");
}

void add_terrain_light(Parser app, TerrainSceneArguments& a) {
  app = app.under("Light");
  add(app, "--sun", "AZIMUTH,ELEVATION",
      "direction of the sun in degrees, clockwise from north and above the horizon (default: "
      "315,35)",
      [&a](const std::string& s) {
        const std::vector<double> v = parse_numbers("--sun", s, 2, "AZIMUTH,ELEVATION");
        if (v[1] > 90)
          throw UsageError("--sun", "the elevation must be at most 90, got '" + s + "'");
        a.light.sun = {v[0], v[1]};
      });
  add_choice(app, "--shadows", "NAME",
             "shadows on the ground: none; accumulated: darker by the number of hidden samples "
             "(paper 3); sharp: exact; soft: with the sun's size (default: none)",
             a.light.shadows, kShadows);
  add_number_that(
      app, "--sun-radius", "DEG",
      "radius of the sun's disc, which casts soft shadows (default: 0.2666)",
      a.light.sun_radius_deg, [](double deg) { return deg >= 0 && deg <= 45; },
      "must lie in 0 to 45");
}

void add_terrain_machine(Parser app, TerrainSceneArguments& a) {
  app = app.under("Machine");
  TerrainLook& o = a.options;
  add_choice(app, "--method", "NAME",
             "how the picture is computed: fast, or words: by the scans of paper 3; the picture is "
             "the same (default: fast)",
             o.added, {{"fast", nullptr}, {"words", &family::terrain_words()}});
  add_device_options(app, o);
}

terrain::Tiling suited_tiling(const TerrainInput& input) {
  return input.height && io::ends_at_edge(*input.height) ? terrain::Tiling::none
                                                         : terrain::Tiling::repeat;
}

void settle(TerrainSceneArguments& a) {
  if (!a.options.classic && !a.tile_given) a.options.tiling = suited_tiling(a.input);
  if (!a.options.classic) return;
  if (a.dim_sky)
    throw UsageError("--dim-sky", "the sky of --classic has one colour: leave one of them out");
  if (!a.filter_given) a.options.filter = terrain::MapFilter::none;
  a.input.classic_scale = true;
}

Rgba8 sky_of(const terrain::TerrainOptions& options, const terrain::Sun& sun, bool dims) {
  return dims && !options.classic ? terrain::sky_in(options.sky, sun) : options.sky;
}

}  // namespace rastrum::cli
