// SPDX-License-Identifier: BSD-3-Clause
// Scripts: what a person would do, with times, replayed the same way each time (docs/window.md).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "event.hpp"
#include "viewer.hpp"

namespace rastrum::cli::window {

struct Script {
  struct Options {
    std::string line;  ///< as on the command line
  };
  struct Screenshot {
    std::filesystem::path file;
  };
  struct Open {
    std::filesystem::path file;
  };
  struct Size {
    int width, height;
  };
  struct Quit {};
  struct Step {
    double time_s;
    std::variant<Event, Options, Screenshot, Open, Size, Quit> action;
  };

  double fps = 60;
  std::vector<Step> steps;                    ///< times do not decrease
  std::optional<std::filesystem::path> path;  ///< the file itself, where it has camera keys
};

/// Throws Error naming the file, the step and, for a key that is not among `keys`, those that are.
[[nodiscard]] Script read_script(const std::filesystem::path& file, std::span<const KeyHelp> keys);

/// Replays a script on a viewer in even steps of time; each picture is full, whatever it costs, so
/// that two replays give the same pictures.
class Replay {
 public:
  /// Throws Error where the camera keys of the script do not fit what is shown.
  Replay(Script script, Viewer& viewer);

  /// Does what is due, moves time on by a frame and draws. Times are steps / fps.
  void step();
  [[nodiscard]] bool finished() const;
  [[nodiscard]] bool quit() const { return quit_; }
  [[nodiscard]] double fps() const { return script_.fps; }
  /// The size that the script asks for, once.
  [[nodiscard]] std::optional<std::pair<int, int>> take_size() { return std::exchange(size_, {}); }

 private:
  void perform(const Script::Step& step);
  void resize(int width, int height);

  Script script_;
  Viewer& viewer_;
  std::optional<std::pair<double, double>> path_s_;  ///< first and last second of the camera path
  std::size_t frame_ = 0, next_ = 0;
  std::optional<std::pair<int, int>> size_;
  bool quit_ = false;
};

}  // namespace rastrum::cli::window
