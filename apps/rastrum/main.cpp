// The program `rastrum`: parses the command line, runs one subcommand, turns exceptions into one
// line on stderr. Exit status: 0 done, 1 the outside world (files, devices, memory), 2 usage, and
// by a signal (Ctrl-C, a pipe whose reader has gone) that signal.
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

#include <CLI/CLI.hpp>

#include <rastrum/core/error.hpp>

#include "arguments.hpp"
#include "commands.hpp"
#include "signals.hpp"
#include "suggest.hpp"

namespace {

constexpr int kWorldError = 1, kUsageError = 2;

int report(const char* what, int status) {
  rastrum::cli::leave_it_to_the_signal();
  std::fprintf(stderr, "rastrum: error: %s\n", what);
  return status;
}

int report_usage(const char* what, const CLI::App& app) {
  report(what, kUsageError);
  const auto given = app.get_subcommands();
  std::fprintf(stderr, "See rastrum%s%s --help.\n", given.empty() ? "" : " ",
               given.empty() ? "" : given.front()->get_name().c_str());
  return kUsageError;
}

/// For a word that is no command: a mistyped one, or the file that was to be drawn.
std::string not_a_command(const std::string& word, std::span<const std::string_view> commands) {
  std::string known;
  for (const std::string_view c : commands) known.append(known.empty() ? "" : ", ").append(c);
  std::error_code ignored;
  if (std::filesystem::exists(word, ignored))
    return "'" + word + "' is a file, not a command: `rastrum render " + word +
           " -o picture.png` draws it";
  const std::string meant = rastrum::cli::did_you_mean(word, commands);
  return "there is no command '" + word + "'" + (meant.empty() ? "; there are " + known : meant);
}

/// For an option that the command does not have.
std::string not_an_option(const CLI::ExtrasError& error, const CLI::App& app,
                          std::span<char* const> args) {
  std::vector<std::string> names;
  for (const CLI::App* a : app.get_subcommands())
    for (const CLI::Option* option : a->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::vector<std::string_view> known(names.begin(), names.end());
  for (const std::string_view arg : args) {
    const std::string_view name = arg.substr(0, arg.find('='));
    if (name.starts_with("--") && std::ranges::find(known, name) == known.end())
      return "there is no option " + std::string(name) + rastrum::cli::did_you_mean(name, known);
  }
  return error.what();
}

/// What was printed has arrived, or the reason is an error.
int flushed(int status) {
  const bool ok = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  const std::string why = std::strerror(errno);
  rastrum::cli::leave_it_to_the_signal();
  return ok ? status : report(("standard output: cannot be written: " + why).c_str(), kWorldError);
}

}  // namespace

int main(int argc, char** argv) {
  rastrum::cli::end_cleanly_on_signals();
  CLI::App app{"Rastrum draws triangle meshes and terrains in software.", "rastrum"};
  app.set_version_flag("--version", "rastrum " RASTRUM_VERSION);
  app.require_subcommand(1);
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
        rastrum::cli::add_render_command(app), rastrum::cli::add_terrain_command(app),
        rastrum::cli::add_view_command(app),   rastrum::cli::add_view_terrain_command(app),
        rastrum::cli::add_info_command(app),   rastrum::cli::add_make_command(app),
#ifdef RASTRUM_HAS_BENCH
        rastrum::cli::add_bench_command(app),
#endif
    };
    // The options of meshes and of terrains share names, so each has a parser of its own.
    std::vector<const char*> args(argv, argv + argc);
    const auto terrain = std::find_if(args.begin(), args.end(), [](const char* arg) {
      return std::string_view(arg) == "--terrain";
    });
    if (args.size() > 2 && std::string_view(args[1]) == "view" && terrain != args.end()) {
      args.erase(terrain);
      args[1] = "view-terrain";
    }
    std::vector<std::string> names;
    for (const rastrum::cli::Command& command : commands)
      if (!command.parser->get_group().empty()) names.push_back(command.parser->get_name());
    const std::vector<std::string_view> known(names.begin(), names.end());
    const bool hidden = args.size() > 1 && std::string_view(args[1]) == "view-terrain";
    if (args.size() > 1 && args[1][0] != '-' && !hidden &&
        std::ranges::find(known, args[1]) == known.end())
      return report_usage(not_a_command(args[1], known).c_str(), app);
    app.parse(static_cast<int>(args.size()), args.data());
    for (const rastrum::cli::Command& command : commands)
      if (command.parser->parsed()) return flushed(command.run());
    return 0;
  } catch (const CLI::Success& e) {  // --help, --version
    return flushed(app.exit(e));
  } catch (const CLI::ExtrasError& e) {
    return report_usage(not_an_option(e, app, {argv, static_cast<std::size_t>(argc)}).c_str(), app);
  } catch (const CLI::ParseError& e) {
    return report_usage(e.what(), app);
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
