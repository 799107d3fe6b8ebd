// SPDX-License-Identifier: BSD-3-Clause
// The version. CMake, the packages and the tests read it here; CITATION.cff repeats it.
#pragma once

#include <string_view>

#include <rastrum/config.hpp>

/// The version of the headers.
#define RASTRUM_VERSION_MAJOR 0
#define RASTRUM_VERSION_MINOR 1
#define RASTRUM_VERSION_PATCH 0

namespace RASTRUM_API rastrum {

/// The version of the library that runs: "major.minor.patch".
[[nodiscard]] std::string_view version() noexcept;

}  // namespace rastrum
