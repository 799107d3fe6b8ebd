// SPDX-License-Identifier: BSD-3-Clause
// `rastrum view INPUT…` and `rastrum view --terrain …`, if a window is built in.
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>

#include "commands.hpp"
#include "parse/scene_options.hpp"
#include "parse/terrain_options.hpp"
#include "window/mesh_subject.hpp"
#include "window/terrain_subject.hpp"
#include "window/viewer.hpp"
#ifdef RASTRUM_HAS_WINDOW
#include "window/panel.hpp"
#include "window/shell.hpp"
#endif

namespace rastrum::cli {
namespace {

struct WindowArguments {
  std::string script;
  window::ViewerOptions viewer;
};
struct ViewArguments : SceneArguments {
  WindowArguments window;
  bool terrain = false;  ///< for --help alone
};
struct ViewTerrainArguments : TerrainSceneArguments {
  std::vector<std::string> maps;
  GroundShown shown;
  LightChoice lights;
  std::function<bool(const char*)> is_given;  ///< whether an option was given
  WindowArguments window;
};

#ifdef RASTRUM_HAS_WINDOW

int show(std::unique_ptr<window::Subject> subject, WindowArguments& a, int width, int height,
         const window::Controls& controls) {
  a.viewer.width = width;
  a.viewer.height = height;
  window::ShellOptions shell;
  if (!a.script.empty()) {
    std::vector<window::KeyHelp> keys = subject->keys();
    const std::vector<window::KeyHelp> more = window::Viewer::keys();
    keys.insert(keys.end(), more.begin(), more.end());
    shell.script = window::read_script(a.script, keys);
  }
  window::run_shell(std::move(subject), a.viewer, shell, controls);
  return 0;
}

int run(ViewArguments& a) {
  set_look(a, is_to_be_shown(a), true, true);
  check_scene_arguments(a);
  check_annotations(a.annotations, true);
  const window::Display display;  // before a large file is read
  auto subject = std::make_unique<window::MeshSubject>(a, window::load_scene(a));
  window::MeshSubject& meshes = *subject;
  return show(std::move(subject), a.window, a.render.width, a.render.height,
              [&meshes] { window::draw_mesh_controls(meshes); });
}

/// The terrains that F1 goes through: --height, the further files, the function.
std::vector<TerrainInput> maps_of(const ViewTerrainArguments& a) {
  std::vector<TerrainInput> maps;
  TerrainInput one = a.input;
  one.function.clear();
  if (one.color && !one.height) throw UsageError("--color", "needs --height");
  if (one.height) maps.push_back(one);
  for (const std::string& file : a.maps) {
    one.height = file;
    one.color.reset();
    maps.push_back(one);
  }
  if (!a.input.function.empty()) {
    one.height.reset();
    one.color.reset();
    one.function = a.input.function;
    maps.push_back(one);
  }
  if (maps.empty()) throw UsageError("--terrain", "give a height map or --function");
  return maps;
}

int run(ViewTerrainArguments& a) {
  settle(a);
  std::vector<TerrainInput> maps = maps_of(a);
  TerrainSceneArguments first = a;
  first.input = maps.front();
  check_ground(a.shown.ground, first, a.shown.frame, a.lights, true, a.is_given);
  const window::Display display;  // before a large file is read
  auto subject = std::make_unique<window::TerrainSubject>(a, a.shown, std::move(maps));
  window::TerrainSubject& terrain = *subject;
  return show(std::move(subject), a.window, a.options.width, a.options.height,
              [&terrain] { window::draw_terrain_controls(terrain); });
}

#else

template <class Arguments>
int run(Arguments&) {
  throw Error(Errc::unsupported,
              "this rastrum was built without a window: install SDL2 and Dear ImGui (Debian: "
              "libsdl2-dev libimgui-dev) and build it again");
}

#endif

void add_window_options(Parser app, WindowArguments& a) {
  app = app.under("Window");
  add(app, "--script", "FILE",
      "replay the camera path or the list of events in FILE (docs/window.md)",
      [&a](const std::string& s) { a.script = s; });
  add(app, "--screenshots", "NAME", "name of the screenshots (default: rastrum_%04d.png)",
      [&a](const std::string& s) {
        if (!s.ends_with(".png")) throw UsageError("--screenshots", "the name must end in .png");
        a.viewer.screenshots = NumberedName("--screenshots", s);
      });
  add_number_that(app, "--target-ms", "N",
                  "milliseconds that a frame may take while something moves (default: 33)",
                  a.viewer.target_ms, is_above_zero, "must be greater than 0");
}

std::string keys_help(std::span<const window::KeyHelp> camera,
                      std::span<const window::KeyHelp> options) {
  std::string text = "Keys:\n";
  const auto list = [&](std::span<const window::KeyHelp> keys) {
    for (const window::KeyHelp& k : keys)
      text.append("  ").append(k.keys).append(": ").append(k.what).append("\n");
  };
  list(camera);
  list(options);
  list(window::Viewer::keys());
  return text;
}

}  // namespace

Command add_view_command(Parser& app) {
  auto arguments = std::make_shared<ViewArguments>();
  ViewArguments& a = *arguments;
  a.render.background = parse_color("--background", "#20242c");
  Parser view = app.add_subcommand(
      "view", "Look at meshes in a window, or fly over a terrain with --terrain");
  add_input_option(view, a)->required();
  // main sends a terrain's command line to view-terrain.
  view.add_flag("--terrain", a.terrain,
                "fly over a terrain; `rastrum view --terrain --help` shows its options");
  add_window_options(view, a.window);
  add_picture_options(view, a);
  add_look_option(view, a);
  add_transparency_options(view, a);
  add_camera_options(view, a.view);
  add_annotation_options(view, a.annotations);
  add_machine_options(view, a);
  view.footer(
      keys_help(window::MeshControl::keys(), window::MeshSubject::command_keys()) +
      "Drag to orbit; drag with the right button to look around, with the middle one or Shift\n"
      "to pan. The wheel zooms. A file dropped on the window is opened.\n"
      "\nExamples:\n"
      "  rastrum view dragon.ply\n"
      "  rastrum view engine.glb --opacity 0.3 --samples 4\n"
      "  rastrum view builtin:teapot --script flight.json\n"
      "  rastrum view --terrain --height alps.png --color alps.jpg --shadows sharp");
  return {view, [arguments, view] {
            arguments->given = view.all_given();
            return run(*arguments);
          }};
}

Command add_view_terrain_command(Parser& app) {
  auto arguments = std::make_shared<ViewTerrainArguments>();
  ViewTerrainArguments& a = *arguments;
  Parser view =
      app.add_subcommand("view-terrain", "Fly over a terrain (the same as view --terrain)");
  view.group("");
  view.add_option("MAP", a.maps, "more height maps; the key F1 takes the next one")->type_name("");
  add_window_options(view, a.window);
  add_terrain_inputs(view, a);
  add_terrain_camera(view, a);
  add_terrain_picture(view, a);
  add_terrain_light(view, a);
  add_ground_lights(view, a.shown.frame, a.lights);
  add_ground_options(view, a.shown.ground);
  add_terrain_machine(view, a);
  view.footer(
      keys_help(window::TerrainControl::keys(), window::TerrainSubject::command_keys()) +
      "Drag to turn. The wheel climbs. A height map dropped on the window is opened.\n"
      "\nExamples:\n"
      "  rastrum view --terrain --height alps.png --color alps.jpg --shadows sharp\n"
      "  rastrum view --terrain one.dem two.tif --function noise\n"
      "  rastrum view --terrain --height alps.dem --lights studio --cmap viridis --bar Height");
  return {view, [arguments, view] {
            arguments->shown.given = view.all_given();
            arguments->is_given = [view](const char* option) { return view.given(option); };
            return run(*arguments);
          }};
}

}  // namespace rastrum::cli
