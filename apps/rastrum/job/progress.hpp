// SPDX-License-Identifier: BSD-3-Clause
// The progress line, warnings and times of a run.
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

/// One line on stderr that rewrites itself, on a terminal alone.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// At most ten times a second, and not in the first half second.
  void show(const std::string& what);
  /// With the finished share in percent.
  void show(std::string_view what, std::uint64_t done, std::uint64_t all);
  /// So that other text can be written.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_;
  bool visible_ = false;
  Clock::time_point next_;
};

void warn(const std::string& what);
/// Reports a choice that was made, which is no fault.
void note(const std::string& what);

/// In ms since the start of the work.
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
  template <class F>
  void measure(std::string name, const char* category, F&& f) {
    const double begin = now_ms();
    f();
    add({std::move(name), category, begin, now_ms()});
  }
  /// Adds a frame and its stages.
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
