// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/version.hpp>

#define RASTRUM_TEXT(x) #x
#define RASTRUM_VERSION_TEXT(major, minor, patch) \
  RASTRUM_TEXT(major) "." RASTRUM_TEXT(minor) "." RASTRUM_TEXT(patch)

std::string_view rastrum::version() noexcept {
  return RASTRUM_VERSION_TEXT(RASTRUM_VERSION_MAJOR, RASTRUM_VERSION_MINOR, RASTRUM_VERSION_PATCH);
}
