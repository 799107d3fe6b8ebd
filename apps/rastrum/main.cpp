// SPDX-License-Identifier: BSD-3-Clause
// The program `rastrum` runs one subcommand and turns exceptions into one line on stderr. Exit
// status: 0 done, 1 the outside world (files, devices, memory), 2 usage, and after a signal
// (Ctrl-C, a pipe whose reader has gone) that signal.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <apps/command_line/parser.hpp>
#include <rastrum/core/nearest_word.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io/files.hpp>
#include <rastrum/version.hpp>

#include "commands.hpp"
#include "job/system.hpp"
#include "mpi_start.hpp"
#include "parse/arguments.hpp"
#include "signals.hpp"

namespace {

constexpr int kWorldError = 1, kUsageError = 2;

int report(const char* what, int status) {
  rastrum::cli::leave_it_to_the_signal();
  // All ranks got the same wrong arguments, so one reports them.
  if (status == kUsageError && rastrum::cli::started_as_further_rank()) return status;
  std::fprintf(stderr, "rastrum: error: %s\n", rastrum::io::shortened(what).c_str());
  return status;
}

int report_usage(const char* what, const rastrum::cli::Parser& app) {
  report(what, kUsageError);
  if (rastrum::cli::started_as_further_rank()) return kUsageError;
  const std::string given = app.given_subcommand();
  std::fprintf(stderr, "See rastrum%s%s --help.\n", given.empty() ? "" : " ", given.c_str());
  return kUsageError;
}

/// A word that is no command is a mistyped one, or a file.
std::string not_a_command(std::string_view given, std::span<const std::string_view> commands) {
  const std::string word(given);
  std::error_code ignored;
  if (std::filesystem::exists(word, ignored))
    return "'" + word + "' is a file, not a command: `rastrum render " + word +
           " -o picture.png` draws it";
  const std::string meant = rastrum::did_you_mean(word, commands);
  return "there is no command '" + word + "'" +
         (meant.empty() ? "; there are " + rastrum::cli::joined(commands) : meant);
}

/// Returns an error if standard output does not take its text.
int flushed(int status) {
  const bool ok = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  const std::string why = std::strerror(errno);
  rastrum::cli::leave_it_to_the_signal();
  return ok ? status : report(("standard output: cannot be written: " + why).c_str(), kWorldError);
}

}  // namespace

int main(int argc, char** argv) {
  rastrum::cli::prepare_streams();
  rastrum::cli::end_cleanly_on_signals();
  rastrum::io::remember_files_read();
  rastrum::cli::Parser app("rastrum", "Rastrum draws triangle meshes and terrains in software.");
  app.version(std::string("rastrum ").append(rastrum::version()));
  app.require_subcommand();
  app.footer(
      "Examples:\n"
      "  rastrum render bunny.obj -o bunny.png\n"
      "  rastrum render builtin:teapot -o teapot.exr --size 1920x1080 --stats -\n"
      "  rastrum terrain --height map.png --color map.jpg -o flight.png\n"
      "  rastrum info scene.glb\n"
      "  rastrum make 'torus_knot?p=3,q=5' -o knot.ply\n"
      "rastrum COMMAND --help shows the options of each command.");
  try {
    const std::vector<rastrum::cli::Command> commands{
        rastrum::cli::add_render_command(app, rastrum::cli::start_ranks),
        rastrum::cli::add_terrain_command(app),
        rastrum::cli::add_view_command(app),
        rastrum::cli::add_view_terrain_command(app),
        rastrum::cli::add_info_command(app),
        rastrum::cli::add_make_command(app),
        rastrum::cli::add_bench_command(app),
    };
    // Options of meshes and of terrains share names, so each has a parser.
    std::vector<std::string_view> args(argv + 1, argv + argc);
    const auto terrain = std::ranges::find(args, "--terrain");
    if (!args.empty() && args[0] == "view" && terrain != args.end()) {
      args.erase(terrain);
      args[0] = "view-terrain";
    }
    const std::vector<std::string> names = app.subcommands();
    const std::vector<std::string_view> known(names.begin(), names.end());
    if (!args.empty() && !args[0].starts_with('-') && args[0] != "view-terrain" &&
        std::ranges::find(known, args[0]) == known.end())
      return report_usage(not_a_command(args[0], known).c_str(), app);
    if (!app.parse(args)) return flushed(0);
    if (!args.empty() && args[0] == "terrain")
      rastrum::cli::refuse_ranks("a terrain is drawn by one program alone");
    for (const rastrum::cli::Command& command : commands)
      if (command.parser.parsed()) return flushed(command.run());
    return 0;
  } catch (const rastrum::cli::UsageError& e) {
    return report_usage(e.what(), app);
  } catch (const rastrum::Error& e) {
    return report(e.what(), kWorldError);
  } catch (const std::bad_alloc&) {
    return report("out of memory; try a smaller --size or fewer inputs", kWorldError);
  } catch (const std::exception& e) {
    return report(e.what(), kWorldError);
  }
}
