// SPDX-License-Identifier: BSD-3-Clause
// A virtual X server for a test, and queries about a program's window.
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

/// Polls for minutes, because a busy machine under a sanitizer is slow. False: it did not come
/// true.
bool wait_until(const std::function<bool()>& done);

/// A child process that ends with the test.
class Process {
 public:
  Process() = default;
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// `inherit`: a descriptor that stays open in the child, or −1. Its output goes to `said`.
  void start(const std::vector<std::string>& command, const std::filesystem::path& folder,
             const std::filesystem::path& said, int inherit = -1);
  [[nodiscard]] bool running();
  void signal(int number) const;
  /// Sends the signal and waits for the end.
  void stop(int signal);
  [[nodiscard]] pid_t id() const { return child_; }
  /// Like Outcome::status; −1 while it runs.
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

  /// Null if there is no server.
  [[nodiscard]] XDisplay* display() const { return display_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Why there is no server.
  [[nodiscard]] std::string said() const;

  /// The visible window of a process, else 0.
  [[nodiscard]] XWindow window_of(pid_t process) const;
  [[nodiscard]] std::string title(XWindow window) const;
  /// Gives the window the keyboard, because there is no window manager. Returns whether it has it.
  [[nodiscard]] bool focus(XWindow window) const;
  void resize(XWindow window, int width, int height) const;
  /// Asks the window to close, as a window manager's button does.
  void close(XWindow window) const;
  /// The copied text; empty if there is none.
  [[nodiscard]] std::string clipboard() const;
  /// A window's pixels from (x, y) on, as on the server; empty if it has none.
  [[nodiscard]] Image<Rgba8> pixels(XWindow window, int x, int y, int width, int height) const;

 private:
  /// Starts the server with this number. True: it gave up at once, and another number may work.
  bool fails_with(int number);

  TempFolder folder_;
  std::string name_;
  Process process_;
  XDisplay* display_ = nullptr;
};

/// Drags a file over the middle of a window and drops it like a file manager. Returns "" or the
/// error.
[[nodiscard]] std::string drop_file(const XServer& server, XWindow window,
                                    const std::filesystem::path& file);

}  // namespace rastrum::test
