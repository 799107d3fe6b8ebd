// The subcommands of the program. Each file adds its own to the parser and returns what runs it.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace rastrum::cli {

struct Command {
  CLI::App* parser;          ///< parsed() says whether this subcommand was given
  std::function<int()> run;  ///< after parsing; returns the exit status
};

[[nodiscard]] Command add_render_command(CLI::App& app);
[[nodiscard]] Command add_terrain_command(CLI::App& app);
[[nodiscard]] Command add_info_command(CLI::App& app);
[[nodiscard]] Command add_make_command(CLI::App& app);
[[nodiscard]] Command add_bench_command(CLI::App& app);

}  // namespace rastrum::cli
