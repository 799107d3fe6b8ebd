// What a test takes from its surroundings: counts from the environment.
#pragma once

#include <cstdlib>
#include <string>

namespace rastrum::test {

/// The number in the environment variable `name`, or `usual`. Sanitizer runs ask for fewer scenes.
inline int count_from_environment(const char* name, int usual) {
  const char* const asked = std::getenv(name);
  return asked != nullptr ? std::stoi(asked) : usual;
}

}  // namespace rastrum::test
