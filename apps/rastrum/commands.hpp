// The subcommands of the program. Each file adds its own to the parser and returns what runs it.
#pragma once

#include <functional>

#include <apps/command_line/parser.hpp>

namespace rastrum::cli {

struct Command {
  Parser parser;             ///< parsed() says whether this subcommand was given
  std::function<int()> run;  ///< after parsing; returns the exit status
};

[[nodiscard]] Command add_render_command(Parser& app);
[[nodiscard]] Command add_terrain_command(Parser& app);
[[nodiscard]] Command add_info_command(Parser& app);
[[nodiscard]] Command add_make_command(Parser& app);
[[nodiscard]] Command add_view_command(Parser& app);
[[nodiscard]] Command add_view_terrain_command(Parser& app);  ///< `view --terrain`, see main
[[nodiscard]] Command add_bench_command(Parser& app);

}  // namespace rastrum::cli
