// SPDX-License-Identifier: BSD-3-Clause
// The options that say what is drawn and how, shared by the commands that draw meshes.
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

/// Which defaults of light, corner and samples apply where nothing else is given (docs/light.md).
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
  std::vector<Parser::Given> given;  ///< the options of the command line, where they are kept
};

/// Adds --format, for a command that reads meshes.
void add_reading_options(Parser app, InputReading& reading);
/// Adds INPUT, --format and the groups of options to `app`; parsing fills `a`, which must outlive
/// it.
Option add_input_option(Parser& app, SceneArguments& a);
void add_picture_options(Parser app, SceneArguments& a);
void add_transparency_options(Parser app, SceneArguments& a);
void add_machine_options(Parser app, SceneArguments& a);
inline constexpr const char* kMachineGroup = "Machine";
/// Parts of these, for pictures that something else begins and the scene is drawn into.
void add_shading_options(Parser app, SceneArguments& a);
void add_blending_options(Parser app, SceneArguments& a);
void add_rasterizer_options(Parser app, SceneArguments& a);

void add_look_option(Parser app, SceneArguments& a);
/// Whether nothing is said of how a picture is found: then nobody compares it with others.
[[nodiscard]] bool is_to_be_shown(const SceneArguments& a);
/// The picture of those who do not say how. `shows`: light and samples are those of a picture to
/// show, where `look` says neither; `has_corner`: a corner is chosen where nothing is said of the
/// camera; `has_colors`: there are some to darken.
void set_look(SceneArguments& a, bool shows, bool has_corner, bool has_colors);

/// `auto` and the names of an axis.
[[nodiscard]] std::vector<std::string> axis_names(const std::vector<family::AxisInfo>& axis);

/// The shapes of INPUT and their defaults, for the end of --help.
[[nodiscard]] std::string shapes_help();

/// The method of a name, or filter:K with K from 1 to 64, into `options`. Throws UsageError that
/// lists them.
void parse_transparency(const std::string& text, TransparencyOptions& options);
/// The names that parse_transparency knows.
[[nodiscard]] std::string transparency_list();
/// The same one by one, with the filter as `now` has it, else of 3.
[[nodiscard]] std::vector<std::string> transparency_names(const TransparencyOptions& now);
/// The one that parse_transparency reads as these options.
[[nodiscard]] std::string transparency_name(const TransparencyOptions& options);
/// K of filter:K; 0 for other methods.
[[nodiscard]] int filter_of(const TransparencyOptions& options);

/// From the CLI's text after --alpha-threshold; empty: paper 4's 1 − 1/128. Throws UsageError.
[[nodiscard]] float parse_alpha_threshold(const std::string& text);

/// Checks what the parser cannot see by itself, before anything is read. Throws UsageError.
void check_scene_arguments(const SceneArguments& a);

}  // namespace rastrum::cli
