// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench NAME`: what the program calls.
#pragma once

#include <span>
#include <string_view>

namespace rastrum::bench {

/// Runs the benchmark that `args` names, with the options that follow it, and prints its table.
/// Without arguments, or with `--help`, it lists the benchmarks. Returns the program's exit status:
/// 0, 1 where a picture that is checked before it is timed is wrong, 2 for a usage error.
/// Throws Error for what the outside world does wrong (files, devices, memory).
int run(std::span<const std::string_view> args);

}  // namespace rastrum::bench
