// The options that say what is drawn and how, shared by the commands that draw meshes.
#pragma once

#include <string>
#include <vector>

#include <rastrum/family.hpp>

#include "inputs.hpp"
#include "light_options.hpp"
#include "option.hpp"
#include "view.hpp"

namespace rastrum::cli {

struct SceneArguments {
  std::vector<std::string> inputs;
  std::string format;  ///< of inputs whose names do not say
  family::Options render;
  NormalOptions normals;
  PixelSizes sizes;
  bool crease_given = false;
  ViewOptions view;
  bool fit = false;
  bool samples_given = false;
  LightChoice lights;
};

/// Adds --format, for a command that reads meshes.
void add_format_option(Parser& app, std::string& format);
/// Adds INPUT, --format and the groups of options to `app`; parsing fills `a`, which must outlive
/// it.
Option add_input_option(Parser& app, SceneArguments& a);
void add_picture_options(Parser& app, SceneArguments& a);
void add_transparency_options(Parser& app, SceneArguments& a);
void add_camera_options(Parser& app, SceneArguments& a);
void add_machine_options(Parser& app, SceneArguments& a);
inline constexpr const char* kMachineGroup = "Machine";
/// Parts of these, for pictures that something else begins and the scene is drawn into.
void add_shading_options(Parser& app, SceneArguments& a, const char* group);
void add_blending_options(Parser& app, SceneArguments& a, const char* group);
void add_rasterizer_options(Parser& app, SceneArguments& a, const char* group);

/// The shapes of INPUT and their defaults, for the end of --help.
[[nodiscard]] std::string shapes_help();

/// What the parser cannot see by itself, before anything is read. Throws UsageError.
void check_scene_arguments(const SceneArguments& a);

}  // namespace rastrum::cli
