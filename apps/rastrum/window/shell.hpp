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

/// SDL's connection to a display. Throws Error{no_device} if a window would not be visible: SDL
/// would take a driver that draws nowhere, and wait for keys. A script that asks for such a driver
/// by SDL_VIDEODRIVER gets it.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
};

/// Draws a subject's controls with ImGui, inside of the panel's window.
using Controls = std::function<void()>;

/// Shows the window until it is closed. Requires a Display. Throws Error{no_device} if the window
/// cannot be opened.
void run_shell(std::unique_ptr<Subject> subject, const ViewerOptions& viewer,
               const ShellOptions& options, const Controls& controls);

}  // namespace rastrum::cli::window
