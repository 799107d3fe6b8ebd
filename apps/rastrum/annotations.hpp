// Words, axes and effects over a finished picture, as options of the commands that draw one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/scene.hpp>

#include "option.hpp"
#include "scalar_options.hpp"

namespace rastrum::cli {

/// What is written over a picture, of whatever kind.
struct WordOptions {
  std::string title;
  std::vector<std::string> captions;
  double scale = 1;
  bool scale_given = false;

  [[nodiscard]] bool any() const { return !title.empty() || !captions.empty(); }
};

/// What needs a scene and its camera, too.
struct AnnotationOptions {
  WordOptions words;
  ScalarOptions scalars;  ///< whose bar is drawn
  bool axes = false, bounds = false;
  bool occlusion = false, dome = false, silhouettes = false, edges = false;
  std::optional<double> occlusion_radius, occlusion_strength, dome_strength;
  std::optional<double> edge_angle, edge_width;

  /// Those that look at depth.
  [[nodiscard]] bool effects() const { return occlusion || dome || silhouettes; }
  [[nodiscard]] bool any() const {
    return words.any() || scalars.bar() || axes || bounds || edges || effects();
  }
};

void add_word_options(Parser& app, WordOptions& a, const char* group);
void add_annotation_options(Parser& app, AnnotationOptions& a);
/// What the parser cannot see by itself. `has_colors`: a picture in colours is drawn. Throws
/// UsageError.
void check_words(const WordOptions& a, bool has_colors);
void check_annotations(const AnnotationOptions& a, bool has_colors);
/// Warns of letters that the font has not.
void report_missing_glyphs(const WordOptions& a, const std::string& more = {});

/// `look` at the size that was asked for.
[[nodiscard]] overlay::Look look_of(const WordOptions& a, Vec4 background);
void draw_words(const WordOptions& a, const overlay::Canvas& canvas, const overlay::Look& look);

/// A camera that leaves a margin for the numbers of --bounds, or for --bar, around what it was
/// fitted to.
[[nodiscard]] Camera with_room(const AnnotationOptions& a, Camera camera, const SceneView& scene,
                               int width, int height);

/// Effects, then the box, axes and words, onto `canvas`. `surface` must be there for effects,
/// `depth` (reversed) for bounds, `ids` for edges.
void annotate(const AnnotationOptions& a, const overlay::Canvas& canvas, const Surface& surface,
              ImageView<const float> depth, ImageView<const std::int64_t> ids,
              const SceneView& scene, const Camera& camera, Vec4 background, Effects& effects);

}  // namespace rastrum::cli
