// One timed part of a frame.
#pragma once

#include <string>

namespace rastrum {

/// In ms since the frame began.
struct StageTime {
  std::string name;
  double begin_ms = 0, end_ms = 0;
};

}  // namespace rastrum
