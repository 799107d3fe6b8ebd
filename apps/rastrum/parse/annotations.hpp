// SPDX-License-Identifier: BSD-3-Clause
// Words, axes and effects over a finished picture, as options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <rastrum/annotate.hpp>

#include "arguments.hpp"
#include "scalar_options.hpp"

namespace rastrum::cli {

struct WordOptions {
  std::string title;
  std::vector<std::string> captions;
  double scale = 1;
  bool scale_given = false;

  [[nodiscard]] bool any() const { return !title.empty() || !captions.empty(); }
};

/// For scenes: these also need the scene and its camera.
struct AnnotationOptions {
  WordOptions words;
  ScalarOptions scalars;  ///< whose bar is drawn
  bool axes = false, bounds = false;
  bool occlusion = false, dome = false, silhouettes = false, edges = false;
  std::optional<double> occlusion_radius, occlusion_strength, dome_strength;
  std::optional<double> edge_angle, edge_width;

  [[nodiscard]] bool any() const {
    return words.any() || scalars.bar() || axes || bounds || edges || occlusion || dome ||
           silhouettes;
  }
};

void add_word_options(Parser app, WordOptions& a);
void add_annotation_options(Parser app, AnnotationOptions& a);
/// Checks what the parser cannot check. `has_colors`: a picture in colours is drawn. Throws
/// UsageError.
void check_words(const WordOptions& a, bool has_colors);
void check_annotations(const AnnotationOptions& a, bool has_colors);
/// A warning about letters that the font lacks; empty if it has all.
[[nodiscard]] std::string missing_glyphs(const WordOptions& a, const std::string& more = {});

/// Translates the options for the library (rastrum/annotate.hpp).
[[nodiscard]] Annotations meant(const WordOptions& a);
[[nodiscard]] Annotations meant(const AnnotationOptions& a);

}  // namespace rastrum::cli
