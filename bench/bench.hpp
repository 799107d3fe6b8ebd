// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench NAME`: what the program calls.
#pragma once

#include <span>
#include <string_view>

namespace rastrum::bench {

/// Runs the benchmark that `args` names, with the options that follow it, and prints its table.
/// Without arguments, or with `--help`, lists the benchmarks. Returns the exit status: 0, 1 if a
/// picture is wrong (pictures are checked before the timing), 2 for a usage error. Throws Error for
/// faults of files, devices and memory.
int run(std::span<const std::string_view> args);

}  // namespace rastrum::bench
