// Signs of life during long work: one line on stderr that rewrites itself, on a terminal alone.
#pragma once

#include <chrono>
#include <string>

namespace rastrum::cli {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows `what`, at most ten times a second and not in the first half second.
  void show(const std::string& what);
  /// Removes the line, so that other text can be written.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_;
  bool visible_ = false;
  Clock::time_point next_;
};

/// Writes `warning: …` to stderr.
void warn(const std::string& what);
/// The same of what is no fault: a choice that was made.
void note(const std::string& what);

}  // namespace rastrum::cli
