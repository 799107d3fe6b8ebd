// SPDX-License-Identifier: BSD-3-Clause
#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include <rastrum/io/files.hpp>

#include "json_file.hpp"

namespace rastrum::cli {

Progress::Progress(bool quiet)
    : active_(!quiet && ::isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + std::chrono::milliseconds(500)) {}

void Progress::show(const std::string& what) {
  if (!active_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\r\x1b[K%s", what.c_str());
  std::fflush(stderr);
  visible_ = true;
}

void Progress::show(std::string_view what, std::uint64_t done, std::uint64_t all) {
  const std::uint64_t percent = 100 * done / std::max<std::uint64_t>(all, 1);
  show(std::string(what).append(": ").append(std::to_string(percent)).append(" %"));
}

void Progress::clear() {
  if (!visible_) return;
  std::fputs("\r\x1b[K", stderr);
  visible_ = false;
}

void warn(const std::string& what) {
  std::fprintf(stderr, "warning: %s\n", io::shortened(what).c_str());
}
void note(const std::string& what) {
  std::fprintf(stderr, "note: %s\n", io::shortened(what).c_str());
}

void Timeline::add_frame(std::string name, double begin_ms, const FrameStats& frame) {
  add({std::move(name), "frame", begin_ms, begin_ms + frame.frame_ms});
  for (const StageTime& stage : frame.stages)
    add({stage.name, "stage", begin_ms + stage.begin_ms, begin_ms + stage.end_ms});
}

void write_trace(io::AtomicFile& file, const Timeline& timeline) {
  constexpr double kMicrosecondsPerMs = 1000;
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  events.push_back(
      {{"name", "process_name"}, {"ph", "M"}, {"pid", 1}, {"args", {{"name", "rastrum"}}}});
  for (const Timeline::Event& e : timeline.events())
    events.push_back({{"name", e.name},
                      {"cat", e.category},
                      {"ph", "X"},
                      {"ts", e.begin_ms * kMicrosecondsPerMs},
                      {"dur", (e.end_ms - e.begin_ms) * kMicrosecondsPerMs},
                      {"pid", 1},
                      {"tid", 1}});
  write_json(file, {{"traceEvents", std::move(events)}, {"displayTimeUnit", "ms"}});
}

}  // namespace rastrum::cli
