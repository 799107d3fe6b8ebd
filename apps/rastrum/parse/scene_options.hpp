// SPDX-License-Identifier: BSD-3-Clause
// The content and the look of pictures of meshes, as options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <rastrum/family.hpp>

#include "annotations.hpp"
#include "arguments.hpp"
#include "camera_options.hpp"
#include "input_spec.hpp"
#include "light_options.hpp"

namespace rastrum::cli {

/// The defaults of light, corner and samples (docs/light.md).
enum class LookName { studio, plain };

struct SceneArguments {
  std::vector<std::string> inputs;
  InputReading reading;
  family::Options render;
  NormalOptions normals;
  PixelSizes sizes;
  bool crease_given = false;
  ViewOptions view;
  bool samples_given = false;
  LightChoice lights;
  AnnotationOptions annotations;
  std::optional<LookName> look;
  std::vector<Parser::Given> given;  ///< of the command line, if they are kept
};

void add_reading_options(Parser app, InputReading& reading);
/// Parsing fills `a`, which must outlive `app`.
Option add_input_option(Parser& app, SceneArguments& a);
void add_picture_options(Parser app, SceneArguments& a);
void add_transparency_options(Parser app, SceneArguments& a);
void add_machine_options(Parser app, SceneArguments& a);
inline constexpr const char* kMachineGroup = "Machine";
/// Parts of these, for scenes that are drawn into existing pictures.
void add_shading_options(Parser app, SceneArguments& a);
void add_blending_options(Parser app, SceneArguments& a);
void add_rasterizer_options(Parser app, SceneArguments& a);

void add_look_option(Parser app, SceneArguments& a);
/// Whether no option says how a picture is found: then it is not compared with others.
[[nodiscard]] bool is_to_be_shown(const SceneArguments& a);
/// Sets defaults. If `look` is not given: `shows` chooses light and samples of a picture to show,
/// `has_corner` a corner without a given camera; `has_colors`: there are colours to darken.
void set_look(SceneArguments& a, bool shows, bool has_corner, bool has_colors);

[[nodiscard]] std::vector<std::string> axis_names(const std::vector<family::AxisInfo>& axis);

/// For the end of --help.
[[nodiscard]] std::string shapes_help();

/// Parses a method's name, or filter:K with K from 1 to 64. Throws UsageError that lists them.
void parse_transparency(const std::string& text, TransparencyOptions& options);
/// For parse_transparency.
[[nodiscard]] std::string transparency_list();
/// One by one, with the filter of `now`, else of 3.
[[nodiscard]] std::vector<std::string> transparency_names(const TransparencyOptions& now);
/// The name that parse_transparency reads as these options.
[[nodiscard]] std::string transparency_name(const TransparencyOptions& options);
/// K of filter:K; 0 for other methods.
[[nodiscard]] int filter_of(const TransparencyOptions& options);

/// The text of --alpha-threshold; empty: paper 4's 1 − 1/128. Throws UsageError.
[[nodiscard]] float parse_alpha_threshold(const std::string& text);

/// Checks what the parser cannot check, before anything is read. Throws UsageError.
void check_scene_arguments(const SceneArguments& a);

}  // namespace rastrum::cli
