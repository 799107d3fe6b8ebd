// `rastrum view INPUT…`: the window, where it has been built in.
#include <memory>
#include <string>
#include <utility>

#include <rastrum/core/error.hpp>

#include "commands.hpp"
#include "scene_options.hpp"
#include "window/mesh_subject.hpp"
#include "window/viewer.hpp"
#ifdef RASTRUM_HAS_WINDOW
#include "window/panel.hpp"
#include "window/shell.hpp"
#endif

namespace rastrum::cli {
namespace {

struct ViewArguments : SceneArguments {
  std::string script;
  window::ViewerOptions viewer;
};

#ifdef RASTRUM_HAS_WINDOW
int run(ViewArguments& a) {
  check_scene_arguments(a);
  a.viewer.width = a.render.width;
  a.viewer.height = a.render.height;
  auto subject = std::make_unique<window::MeshSubject>(a, window::load_scene(a));
  window::ShellOptions shell;
  if (!a.script.empty()) {
    std::vector<window::KeyHelp> keys = subject->keys();
    const std::vector<window::KeyHelp> more = window::Viewer::keys();
    keys.insert(keys.end(), more.begin(), more.end());
    shell.script = window::read_script(a.script, keys);
  }
  window::MeshSubject& meshes = *subject;
  window::run_shell(std::move(subject), a.viewer, shell,
                    [&meshes] { window::draw_mesh_controls(meshes); });
  return 0;
}
#else
int run(ViewArguments&) {
  throw Error(Errc::unsupported,
              "this rastrum was built without a window: install SDL2 and Dear ImGui (Debian: "
              "libsdl2-dev libimgui-dev) and build it again");
}
#endif

}  // namespace

Command add_view_command(CLI::App& app) {
  auto arguments = std::make_shared<ViewArguments>();
  ViewArguments& a = *arguments;
  a.render.background = parse_color("--background", "#20242c");
  CLI::App& view = *app.add_subcommand("view", "Look at meshes and shapes in a window");
  add_input_option(view, a)->required();
  const char* group = "Window";
  add(view, "--script", "FILE", "replay a camera path or a list of events (docs/window.md)",
      [&a](const std::string& s) { a.script = s; })
      ->group(group);
  add(view, "--screenshots", "NAME", "what screenshots are called (rastrum_%04d.png)",
      [&a](const std::string& s) {
        if (!s.ends_with(".png")) throw UsageError("--screenshots", "the name must end in .png");
        a.viewer.screenshots = NumberedName("--screenshots", s);
      })
      ->group(group);
  add(view, "--target-ms", "N", "milliseconds that a frame may take while something moves (33)",
      [&a](const std::string& s) {
        a.viewer.target_ms = parse_number("--target-ms", s);
        if (!(a.viewer.target_ms > 0)) throw UsageError("--target-ms", "must be greater than 0");
      })
      ->group(group);
  add_picture_options(view, a);
  add_transparency_options(view, a);
  add_camera_options(view, a);
  add_machine_options(view, a);
  std::string footer = "Keys:\n";
  const auto list = [&](const window::KeyHelp& k) {
    footer.append("  ").append(k.keys).append(": ").append(k.what).append("\n");
  };
  for (const window::KeyHelp& k : window::MeshControl::keys()) list(k);
  for (const window::KeyHelp& k : window::MeshSubject::command_keys()) list(k);
  for (const window::KeyHelp& k : window::Viewer::keys()) list(k);
  footer +=
      "Drag to orbit, with the right button to look around, with the middle one or Shift to pan;\n"
      "the wheel zooms; a file dropped on the window is opened.\n"
      "\nExamples:\n"
      "  rastrum view dragon.ply\n"
      "  rastrum view engine.glb --opacity 0.3 --samples 4\n"
      "  rastrum view builtin:teapot --script flight.json";
  view.footer(footer);
  return {&view, [arguments] { return run(*arguments); }};
}

}  // namespace rastrum::cli
