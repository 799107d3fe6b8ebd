// SPDX-License-Identifier: BSD-3-Clause
// Each file adds its subcommand to the parser and returns the function that runs it.
#pragma once

#include <functional>
#include <memory>

#include <apps/command_line/parser.hpp>

#include "job/ranks_of_program.hpp"

namespace rastrum::cli {

struct Command {
  Parser parser;             ///< parsed(): whether this subcommand was given
  std::function<int()> run;  ///< after parsing; returns the exit status
};

/// The ranks if the program was started as one of several, else null. `timeout_s`: how long one
/// waits for others, 0: for ever. Throws Error{unsupported} if MPI is not available.
using StartRanks = std::function<std::unique_ptr<RanksOfProgram>(double timeout_s)>;
[[nodiscard]] Command add_render_command(Parser& app, StartRanks start = {});
[[nodiscard]] Command add_terrain_command(Parser& app);
[[nodiscard]] Command add_info_command(Parser& app);
[[nodiscard]] Command add_make_command(Parser& app);
[[nodiscard]] Command add_view_command(Parser& app);
[[nodiscard]] Command add_view_terrain_command(Parser& app);  ///< `view --terrain`, see main
[[nodiscard]] Command add_bench_command(Parser& app);

}  // namespace rastrum::cli
