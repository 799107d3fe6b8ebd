// The window itself: SDL's events to a Viewer, its pictures and the panel to the screen.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "script.hpp"
#include "viewer.hpp"

namespace rastrum::cli::window {

struct ShellOptions {
  std::optional<Script> script;
};

/// Draws the controls of a subject with ImGui; called inside of the panel's window.
using Controls = std::function<void()>;

/// Shows the window until it is closed. Throws Error{no_device} where there is no display.
void run_shell(std::unique_ptr<Subject> subject, const ViewerOptions& viewer,
               const ShellOptions& options, const Controls& controls);

}  // namespace rastrum::cli::window
