// SPDX-License-Identifier: BSD-3-Clause
#include "scalar_options.hpp"

#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/overlay.hpp>

namespace rastrum::cli {
namespace {

std::vector<double> parse_numbers(const char* option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : parts_of(text, ",")) numbers.push_back(parse_number(option, part));
  return numbers;
}

ScalarRange parse_range(const std::string& text) {
  const std::vector<double> ends = parse_numbers("--range", text);
  if (ends.size() != 2)
    throw UsageError("--range", "expected LOW,HIGH as in 0,100, got '" + text + "'");
  if (ends[0] > ends[1])
    throw UsageError("--range",
                     "the first number must not be above the second, got '" + text + "'");
  return {ends[0], ends[1]};
}

std::vector<ScalarOpacity> parse_opacity(const std::string& text) {
  std::vector<ScalarOpacity> all;
  for (const std::string& part : parts_of(text, ",")) {
    const std::vector<std::string> pair = parts_of(part, ":");
    if (pair.size() != 2)
      throw UsageError("--scalar-opacity",
                       "expected VALUE:OPACITY,... as in 0:0,10:1, got '" + text + "'");
    all.push_back({parse_number("--scalar-opacity", pair[0]),
                   static_cast<float>(parse_number("--scalar-opacity", pair[1]))});
  }
  return all;
}

ColorMap parse_map(const std::string& text) {
  try {
    return color_map_or_list(text);
  } catch (const Error& e) {
    throw UsageError("--cmap", e.what());
  }
}

/// Names the option of the field that a ScalarMapping refused.
UsageError of_option(const Error& e) {
  constexpr std::pair<std::string_view, const char*> kOptions[] = {
      {"map", "--cmap"},
      {"range", "--range"},
      {"logarithmic", "--log"},
      {"steps", "--steps"},
      {"categories", "--categories"},
      {"below", "--below"},
      {"above", "--above"},
      {"nan", "--nan-color"},
      {"opacity", "--scalar-opacity"},
      {"isolines", "--isolines"},
      {"isoline_color", "--isoline-color"},
      {"isoline_px", "--isoline-width"}};
  constexpr std::string_view kBegin = "ScalarMapping::";
  std::string_view what = e.what();
  if (what.starts_with(kBegin)) what.remove_prefix(kBegin.size());
  const std::string_view field = what.substr(0, what.find_first_of(":["));
  for (const auto& [name, option] : kOptions)
    if (name == field) {
      what.remove_prefix(field.size());
      if (what.starts_with(": ")) what.remove_prefix(2);
      return {option, std::string(what)};
    }
  return {"--scalars", e.what()};
}

}  // namespace

void add_scalar_options(Parser app, ScalarOptions& s, NumbersOf of) {
  const bool is_terrain = of == NumbersOf::terrain;
  const Parser listed = app.under("Numbers as colours");
  app = listed;
  add(app, "--scalars", "NAME",
      is_terrain ? "height: colour the ground by the heights of the file; the options below take "
                   "numbers of the file, too"
                 : "colour by these numbers of the files (`rastrum info` lists their names), or by "
                   "x, y, z or distance",
      [&s](const std::string& v) {
        s.name = v;
        s.name_given = true;
      });
  const auto add_one = [&](const char* option, const char* type, const std::string& help,
                           auto&& set) {
    add(app, option, type, help, [&s, option, set](const std::string& v) {
      s.given = option;
      set(s, v);
    });
  };
  ScalarMapping& m = s.mapping;
  add_one("--cmap", "NAME",
          "colours from low to high: #rrggbb,#rrggbb,... or a name, which NAME_r reverses "
          "(default: viridis). Names: " +
              joined(color_map_names()),
          [&m](ScalarOptions&, const std::string& v) { m.map = parse_map(v); });
  add_one("--range", "LOW,HIGH",
          "numbers that get the first and the last colour (default: the least and the greatest)",
          [&m](ScalarOptions&, const std::string& v) { m.range = parse_range(v); });
  app.add_flag("--log", m.logarithmic,
               "make the scale of colours logarithmic: equal steps of colour are equal factors");
  app.add_flag("--symmetric", m.symmetric, "put 0 in the middle of the range");
  add_one("--steps", "N", "take so many colours, each for an equal part of the range",
          [&m](ScalarOptions&, const std::string& v) {
            m.steps = parse_integer("--steps", v, 1, 65536);
          });
  add_one("--categories", "V,V,...",
          "give each of these numbers its own colour; all others get that of --nan-color",
          [&m](ScalarOptions&, const std::string& v) {
            m.categories = parse_numbers("--categories", v);
          });
  add_one("--below", "COLOUR", "colour of numbers below the range (default: its first colour)",
          [&m](ScalarOptions&, const std::string& v) { m.below = parse_color("--below", v); });
  add_one("--above", "COLOUR", "colour of numbers above the range (default: its last colour)",
          [&m](ScalarOptions&, const std::string& v) { m.above = parse_color("--above", v); });
  add_one("--nan-color", "COLOUR",
          "colour where there is no number; the bar shows it, too (default: #808080)",
          [](ScalarOptions& all, const std::string& v) {
            all.mapping.nan = parse_color("--nan-color", v);
            all.nan_given = true;
          });
  if (is_terrain) app = app.under("");  // for meshes alone
  add_one("--scalar-opacity", "V:A,V:A,...",
          "opacity at each of these numbers; it is linear between them",
          [&m](ScalarOptions&, const std::string& v) { m.opacity = parse_opacity(v); });
  add_one("--isolines", "N|V,V,...",
          "draw lines of equal numbers on meshes: about N of them, or one for each of these "
          "numbers (V, for a single one)",
          [](ScalarOptions& all, const std::string& v) {
            if (v.find(',') == std::string::npos)
              all.isoline_count = parse_integer("--isolines", v, 1, 1000);
            else
              all.mapping.isolines =
                  parse_numbers("--isolines", v.back() == ',' ? v.substr(0, v.size() - 1) : v);
          });
  add_one("--isoline-color", "COLOUR", "colour of the lines of --isolines (default: black)",
          [](ScalarOptions& all, const std::string& v) {
            all.mapping.isoline_color = parse_color("--isoline-color", v);
            all.of_lines = "--isoline-color";
          });
  add_one("--isoline-width", "PX", "width of the lines of --isolines in pixels (default: 1)",
          [](ScalarOptions& all, const std::string& v) {
            all.mapping.isoline_px = static_cast<float>(parse_number("--isoline-width", v));
            all.of_lines = "--isoline-width";
          });
  app = listed;
  add_one("--bar", "TITLE", "draw a bar with this title that says which colour is which number",
          [](ScalarOptions& all, const std::string& v) { all.bar_title = v; });
  add_one("--bar-unit", "UNIT", "unit, written behind the title of --bar",
          [](ScalarOptions& all, const std::string& v) { all.bar_unit = v; });
}

void check_scalars(const ScalarOptions& s, bool has_colors) {
  if (s.name.empty()) {
    if (s.name_given)
      throw UsageError("--scalars",
                       "the name is empty; `rastrum info` lists the names of a file's numbers");
    const char* const option = s.given != nullptr      ? s.given
                               : s.mapping.logarithmic ? "--log"
                               : s.mapping.symmetric   ? "--symmetric"
                                                       : nullptr;
    if (option != nullptr) throw UsageError(option, "needs numbers: say which, as in --scalars z");
    return;
  }
  if (s.bar() && !has_colors) throw UsageError("--bar", "needs a picture: give -o");
  if (!s.bar() && !s.bar_unit.empty()) throw UsageError("--bar-unit", "needs --bar");
  if (s.of_lines != nullptr && s.isoline_count == 0 && s.mapping.isolines.empty())
    throw UsageError(s.of_lines, "needs --isolines");
  try {
    // Refuses mappings that are wrong for any numbers.
    ScalarMapping m = s.mapping;
    if (!m.range) m.range = ScalarRange{1, 2};
    static_cast<void>(ScalarColors(m, {}));
  } catch (const Error& e) {
    throw of_option(e);
  }
}

void set_scalars(const ScalarOptions& s, Scene& scene) {
  if (s.name.empty()) return;
  show_scalars(scene, s.name);
  scene.scalar_mappings = {s.mapping};
  if (s.isoline_count != 0)
    add_isolines(s, scalar_colors(SceneBinding(scene).view()).range(), scene);
}

void add_isolines(const ScalarOptions& s, ScalarRange range, Scene& scene) {
  for (const overlay::Tick& tick :
       overlay::ticks(range.low, range.high, s.isoline_count, s.mapping.logarithmic))
    scene.scalar_mappings[0].isolines.push_back(tick.value);
}

std::optional<BarWords> bar_words(const ScalarOptions& s) {
  if (!s.bar()) return {};
  return BarWords{*s.bar_title, s.bar_unit, s.nan_given};
}

}  // namespace rastrum::cli
