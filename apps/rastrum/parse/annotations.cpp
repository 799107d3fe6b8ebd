// SPDX-License-Identifier: BSD-3-Clause
#include "annotations.hpp"

#include <cstdio>
#include <string>

namespace rastrum::cli {
namespace {

/// A number in [least, most], or above 0 if least is 0.
void add_number(Parser app, const char* option, const char* type, const char* help,
                std::optional<double>& value, double least, double most) {
  add(app, option, type, help, [option, least, most, &value](const std::string& s) {
    value = parse_number(option, s);
    if (*value > 0 && *value >= least && *value <= most) return;
    char range[64];
    std::snprintf(range, sizeof range,
                  least > 0 ? "must lie in %g to %g" : "must lie above %g, up to %g", least, most);
    throw UsageError(option, std::string(range) + ", got '" + s + "'");
  });
}

}  // namespace

void add_word_options(Parser app, WordOptions& a) {
  add(app, "--title", "TEXT",
      "write these words at the top of the picture; UTF-8, \\n begins a new line",
      [&a](const std::string& s) { a.title = s; });
  app.add_repeated("--caption", "TEXT",
                   "write smaller words in a corner: the first ones at the bottom right, then top "
                   "left, top right, bottom left; may be repeated",
                   [&a](const std::string& s) {
                     if (a.captions.size() == 4)
                       throw UsageError("--caption",
                                        "at most four captions are possible, one in each corner");
                     a.captions.push_back(s);
                   });
  add(app, "--text-scale", "S",
      "scale all words, and the lines of --bar, --axes and --bounds (default: 1)",
      [&a](const std::string& s) {
        a.scale = parse_number_that(
            "--text-scale", s, [](double scale) { return scale > 0 && scale <= 100; },
            "must lie in 0 to 100");
        a.scale_given = true;
      });
}

void add_annotation_options(Parser app, AnnotationOptions& a) {
  add_scalar_options(app, a.scalars);
  app = app.under("Words and effects");
  add_word_options(app, a.words);
  app.add_flag("--axes", a.axes, "draw the directions of x, y and z in the bottom left corner");
  app.add_flag("--bounds", a.bounds,
               "draw a box around the scene with ticks and numbers; the fitted camera leaves a "
               "margin for it");
  app.add_flag("--occlusion", a.occlusion,
               "darken places where nearby surfaces shut out light (ambient occlusion)");
  add_number(app, "--occlusion-radius", "R",
             "how far away a surface still shuts out light, in the scene's units (default: 0.15 of "
             "the scene's radius)",
             a.occlusion_radius, 1e-37, 1e37);
  add_number(app, "--occlusion-strength", "S", "how strongly --occlusion darkens (default: 1)",
             a.occlusion_strength, 0, 16);
  app.add_flag("--edl", a.dome,
               "darken what lies behind its neighbours (eye-dome lighting); it gives clouds of "
               "points a shape");
  add_number(app, "--edl-strength", "S", "how strongly --edl darkens (default: 1)", a.dome_strength,
             0, 100);
  app.add_flag(
      "--silhouettes", a.silhouettes,
      "draw a black line where a surface ends, bends by more than 35 degrees or meets another one");
  app.add_flag("--edges", a.edges, "draw the visible edges of the meshes as black lines");
  add_number_that(
      app, "--edge-angle", "DEG",
      "draw an edge between two faces only where they meet at more than this angle; 30 leaves "
      "creases and borders (default: 0, all edges)",
      a.edge_angle, [](double deg) { return deg >= 0 && deg <= 180; },
      "must lie in 0 to 180 degrees");
  add_number(app, "--edge-width", "PX", "width of the lines of --edges in pixels (default: 1)",
             a.edge_width, 0, 64);
}

void check_words(const WordOptions& a, bool has_colors) {
  if (a.any() && !has_colors)
    throw UsageError(a.title.empty() ? "--caption" : "--title", "needs a picture: give -o");
}

void check_annotations(const AnnotationOptions& a, bool has_colors) {
  check_words(a.words, has_colors);
  check_scalars(a.scalars, has_colors);
  if (a.any() && !has_colors)
    throw UsageError(a.axes        ? "--axes"
                     : a.bounds    ? "--bounds"
                     : a.occlusion ? "--occlusion"
                     : a.dome      ? "--edl"
                     : a.edges     ? "--edges"
                                   : "--silhouettes",
                     "needs a picture: give -o");
  if ((a.occlusion_radius || a.occlusion_strength) && !a.occlusion)
    throw UsageError(a.occlusion_radius ? "--occlusion-radius" : "--occlusion-strength",
                     "needs --occlusion");
  if ((a.edge_angle || a.edge_width) && !a.edges)
    throw UsageError(a.edge_angle ? "--edge-angle" : "--edge-width", "needs --edges");
  if (a.dome_strength && !a.dome) throw UsageError("--edl-strength", "needs --edl");
  if (a.words.scale_given && !a.words.any() && !a.scalars.bar() && !a.axes && !a.bounds)
    throw UsageError("--text-scale",
                     "scales --title, --caption, --bar, --axes and --bounds; give one of them");
}

std::string missing_glyphs(const WordOptions& a, const std::string& more) {
  std::string all = a.title + more;
  for (const std::string& caption : a.captions) all += caption;
  std::string codes;
  for (const char32_t code : overlay::missing_glyphs(all)) {
    char text[16];
    std::snprintf(text, sizeof text, "U+%04X", static_cast<unsigned>(code));
    codes.append(codes.empty() ? "" : ", ").append(text);
  }
  return codes.empty() ? "" : "the font has no " + codes + ": drawn as boxes";
}

Annotations meant(const WordOptions& a) {
  Annotations meant;
  meant.title = a.title;
  meant.captions = a.captions;
  meant.text_scale = a.scale;
  return meant;
}

Annotations meant(const AnnotationOptions& a) {
  Annotations meant = cli::meant(a.words);
  if (a.occlusion) {
    meant.occlusion.emplace();
    meant.occlusion->radius = a.occlusion_radius.value_or(0);
    meant.occlusion->strength = a.occlusion_strength.value_or(meant.occlusion->strength);
  }
  if (a.dome) {
    meant.dome.emplace();
    meant.dome->strength = a.dome_strength.value_or(meant.dome->strength);
    meant.dome->radius_px = 0;
  }
  if (a.silhouettes) meant.silhouettes.emplace();
  if (a.edges) meant.edges = {a.edge_angle.value_or(0), a.edge_width.value_or(1)};
  meant.bounds = a.bounds;
  meant.axes = a.axes;
  meant.bar = bar_words(a.scalars);
  return meant;
}

}  // namespace rastrum::cli
