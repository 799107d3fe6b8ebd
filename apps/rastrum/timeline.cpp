#include "timeline.hpp"

#include <nlohmann/json.hpp>

#include "json_file.hpp"

namespace rastrum::cli {

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
