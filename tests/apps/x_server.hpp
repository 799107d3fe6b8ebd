// SPDX-License-Identifier: BSD-3-Clause
// A virtual X server of the test's own, and what a test asks it about a program's window.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <rastrum/image.hpp>

#include "tests/io/files.hpp"

// Declared here, since X11's own headers make macros of common names.
struct _XDisplay;

namespace rastrum::test {

using XDisplay = ::_XDisplay;
using XWindow = unsigned long;

/// Asks again and again, for minutes: a machine that runs everything at once, under a sanitizer, is
/// slow. False: it has not come true.
bool wait_until(const std::function<bool()>& done);

/// A process of the test's own, ended with it.
class Process {
 public:
  Process() = default;
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// `inherit`: a descriptor that stays open in the child, or −1; what it says goes to `said`.
  void start(const std::vector<std::string>& command, const std::filesystem::path& folder,
             const std::filesystem::path& said, int inherit = -1);
  [[nodiscard]] bool running();
  void signal(int number) const;
  /// Sends it and waits for the end.
  void stop(int signal);
  [[nodiscard]] pid_t id() const { return child_; }
  /// As Outcome::status; −1 while it runs.
  [[nodiscard]] int status() const { return status_; }

 private:
  void ended(int status);
  pid_t child_ = -1;
  int status_ = -1;
};

/// Xvfb with a screen of 1024 × 800, and a connection to it.
class XServer {
 public:
  XServer();
  ~XServer();
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  /// Null where there is no server.
  [[nodiscard]] XDisplay* display() const { return display_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Why there is none.
  [[nodiscard]] std::string said() const;

  /// The window of a process once it can be seen, else 0.
  [[nodiscard]] XWindow window_of(pid_t process) const;
  [[nodiscard]] std::string title(XWindow window) const;
  /// Gives it the keyboard, as no window manager is there to do; whether it has it.
  [[nodiscard]] bool focus(XWindow window) const;
  void resize(XWindow window, int width, int height) const;
  /// Asks the window to close, as a window manager's button does.
  void close(XWindow window) const;
  /// The text that somebody has copied; empty: nobody has.
  [[nodiscard]] std::string clipboard() const;
  /// A window's pixels from (x, y) on, as the server has them; empty if it has none.
  [[nodiscard]] Image<Rgba8> pixels(XWindow window, int x, int y, int width, int height) const;

 private:
  /// Starts the server with this number. True: it gave up at once, so another one may do.
  bool fails_with(int number);

  TempFolder folder_;
  std::string name_;
  Process process_;
  XDisplay* display_ = nullptr;
};

/// Drags a file over the middle of a window and drops it, as a file manager does. Empty, or what
/// went wrong.
[[nodiscard]] std::string drop_file(const XServer& server, XWindow window,
                                    const std::filesystem::path& file);

}  // namespace rastrum::test
