// SPDX-License-Identifier: BSD-3-Clause
// The window itself: SDL's events to a Viewer, its pictures and the panel to the screen.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "script.hpp"
#include "viewer.hpp"

namespace rastrum::cli::window {

struct ShellOptions {
  std::optional<Script> script;
};

/// SDL's connection to a display, for as long as this lives. Throws Error{no_device} where nobody
/// would see a window: SDL would otherwise take a driver that draws nowhere, and wait for keys that
/// nobody can press. A script that asks for such a driver by SDL_VIDEODRIVER gets it.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
};

/// Draws the controls of a subject with ImGui; called inside of the panel's window.
using Controls = std::function<void()>;

/// Shows the window until it is closed. Requires a Display. Throws Error{no_device} where the
/// window cannot be opened.
void run_shell(std::unique_ptr<Subject> subject, const ViewerOptions& viewer,
               const ShellOptions& options, const Controls& controls);

}  // namespace rastrum::cli::window
