// SPDX-License-Identifier: BSD-3-Clause
// The program, where systems differ: ../system_posix.cpp and ../system_windows.cpp. Signals and
// films (files/mp4.hpp) differ, too.
#pragma once

#include <string>
#include <vector>

namespace rastrum::cli {

/// Call it before any file is opened: no file takes the place of a closed standard stream. Messages
/// are UTF-8, and the progress line uses escape sequences.
void prepare_streams();

/// The process's peak memory as the system counts it.
[[nodiscard]] double peak_bytes();

/// Becomes the program of this name beside this one. Throws Error{unsupported} if it cannot.
[[noreturn]] void become_program_beside(const char* name,
                                        const std::vector<std::string>& arguments);

}  // namespace rastrum::cli
