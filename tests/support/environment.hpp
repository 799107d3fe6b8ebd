// What a test takes from its surroundings: counts from the environment, threads beyond the cores.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string>

#include <tbb/global_control.h>

namespace rastrum::test {

/// The number in the environment variable `name`, or `usual`. Sanitizer runs ask for fewer scenes.
inline int count_from_environment(const char* name, int usual) {
  const char* const asked = std::getenv(name);
  return asked != nullptr ? std::stoi(asked) : usual;
}

/// oneTBB starts no more threads than there are cores unless told so; a test of 8 threads on a
/// small machine wants 8.
class ThreadsBeyondCores {
 public:
  explicit ThreadsBeyondCores(std::size_t count)
      : control_(tbb::global_control::max_allowed_parallelism, count) {}

 private:
  tbb::global_control control_;
};

}  // namespace rastrum::test
