// SPDX-License-Identifier: BSD-3-Clause
// A run while it works: its line of progress, its warnings, and when it did what.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/io.hpp>

namespace rastrum::cli {

/// Signs of life during long work: one line on stderr that rewrites itself, on a terminal alone.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows `what`, at most ten times a second and not in the first half second.
  void show(const std::string& what);
  /// The same with the share that is done, in percent.
  void show(std::string_view what, std::uint64_t done, std::uint64_t all);
  /// Removes the line, so that other text can be written.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_;
  bool visible_ = false;
  Clock::time_point next_;
};

void warn(const std::string& what);
/// Says a choice that was made, which is no fault.
void note(const std::string& what);

/// Times in ms since the program began its work.
class Timeline {
 public:
  struct Event {
    std::string name;
    const char* category;  ///< "load", "frame", "stage" or "write"
    double begin_ms, end_ms;
  };

  [[nodiscard]] double now_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  void add(Event event) { events_.push_back(std::move(event)); }
  /// Runs f and records it.
  template <class F>
  void measure(std::string name, const char* category, F&& f) {
    const double begin = now_ms();
    f();
    add({std::move(name), category, begin, now_ms()});
  }
  /// A frame and, inside it, its stages.
  void add_frame(std::string name, double begin_ms, const FrameStats& frame);
  [[nodiscard]] std::span<const Event> events() const { return events_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  std::vector<Event> events_;
};

/// The Trace Event Format of Chrome's about:tracing and of Perfetto: "complete" events (ph X) in
/// µs. Throws Error{io}.
void write_trace(io::AtomicFile& file, const Timeline& timeline);

}  // namespace rastrum::cli
