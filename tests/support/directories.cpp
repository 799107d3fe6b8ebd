// SPDX-License-Identifier: BSD-3-Clause
#include "directories.hpp"

#include <cstdlib>

namespace rastrum::test {

std::filesystem::path shared_dir() {
  const char* const asked = std::getenv("RASTRUM_SHARED");
  return asked != nullptr ? asked : RASTRUM_SHARED_DIR;
}
std::filesystem::path shared_data(const std::string& name) {
  return shared_dir() / "data" / name;
}
std::filesystem::path golden_dir() {
  return RASTRUM_GOLDEN_DIR;
}
std::filesystem::path golden_failures_dir() {
  return RASTRUM_GOLDEN_FAILURES_DIR;
}

}  // namespace rastrum::test
