# Writes commit.hpp at build time, so that a figure names the measured code. Changes the file only when its
# contents change.
execute_process(COMMAND git describe --always --dirty --abbrev=12
                WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
// Written by bench/commit.cmake.
#pragma once

namespace rastrum::bench {
inline constexpr const char* kCommit = "@commit@";
inline constexpr const char* kVersion = "@VERSION@";
}  // namespace rastrum::bench
]] @ONLY)
