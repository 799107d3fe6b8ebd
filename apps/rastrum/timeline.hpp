// When the program did what: the source of --trace and of load_ms.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/io.hpp>

namespace rastrum::cli {

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
