// The options that say what is drawn and how, shared by the commands that draw meshes.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <rastrum/render/render.hpp>

#include "arguments.hpp"
#include "inputs.hpp"
#include "view.hpp"

namespace rastrum::cli {

struct SceneArguments {
  std::vector<std::string> inputs;
  RenderOptions render;
  bool shader_given = false;
  Normals normals = Normals::file;
  ViewOptions view;
  bool fit = false;
};

/// One of a few words. Throws UsageError that lists them.
template <class T>
T choose(std::string_view option, const std::string& text,
         std::initializer_list<std::pair<const char*, T>> choices) {
  std::string known;
  for (const auto& [word, value] : choices) {
    if (text == word) return value;
    known.append(known.empty() ? "" : ", ").append(word);
  }
  throw UsageError(option, "expected one of " + known + ", got '" + text + "'");
}

/// An option whose text `parse` turns into a value; what it throws names the option.
template <class F>
CLI::Option* add(CLI::App& app, const char* names, const char* type, const std::string& help,
                 F parse) {
  return app
      .add_option_function<std::string>(
          names, [parse](const std::string& s) { parse(s); }, help)
      ->type_name(type);
}

/// Adds INPUT and the groups of options to `app`; parsing fills `a`, which must outlive it.
CLI::Option* add_input_option(CLI::App& app, SceneArguments& a);
void add_picture_options(CLI::App& app, SceneArguments& a);
void add_transparency_options(CLI::App& app, SceneArguments& a);
void add_camera_options(CLI::App& app, SceneArguments& a);
void add_machine_options(CLI::App& app, SceneArguments& a);
inline constexpr const char* kMachineGroup = "Machine";

/// The shapes of INPUT and their defaults, for the end of --help.
[[nodiscard]] std::string shapes_help();

/// What the parser cannot see by itself, before anything is read. Throws UsageError.
void check_scene_arguments(const SceneArguments& a);

}  // namespace rastrum::cli
