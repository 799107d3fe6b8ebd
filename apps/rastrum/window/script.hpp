// SPDX-License-Identifier: BSD-3-Clause
// Timed actions of a person, replayed the same way each time (docs/window.md).
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
  std::optional<std::filesystem::path> path;  ///< the file itself, if it has camera keys
};

/// Throws Error naming the file, the step and, for an unknown key, `keys`.
[[nodiscard]] Script read_script(const std::filesystem::path& file, std::span<const KeyHelp> keys);

/// Replays a script in even steps of time with full pictures, so that two replays give the same
/// pictures.
class Replay {
 public:
  /// Throws Error if the script's camera keys do not fit the subject.
  Replay(Script script, Viewer& viewer);

  /// Performs what is due, moves time on by a frame and draws.
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
  std::optional<std::pair<double, double>> path_s_;  ///< seconds of the camera path: first, last
  std::size_t frame_ = 0, next_ = 0;
  std::optional<std::pair<int, int>> size_;
  bool quit_ = false;
};

}  // namespace rastrum::cli::window
