// SPDX-License-Identifier: BSD-3-Clause
// Times the stages of a frame.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include <rastrum/frame.hpp>

namespace rastrum::raster {

class Stopwatch {
 public:
  [[nodiscard]] double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  /// Ends the stage that began where the last one ended, or with the frame.
  void lap(FrameStats& stats, std::string stage) {
    const double now = elapsed_ms();
    stats.stages.push_back({std::move(stage), stats.frame_ms, now});
    stats.frame_ms = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace rastrum::raster
