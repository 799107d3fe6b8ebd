// The program `rastrum`: parses the command line, runs one subcommand, turns exceptions into one
// line on stderr. Exit status: 0 done, 1 the outside world (files, devices, memory), 2 usage.
#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include <CLI/CLI.hpp>

#include <rastrum/core/error.hpp>

#include "arguments.hpp"
#include "commands.hpp"

namespace {

constexpr int kWorldError = 1, kUsageError = 2;

int report(const char* what, int status) {
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

}  // namespace

int main(int argc, char** argv) {
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
        rastrum::cli::add_info_command(app),   rastrum::cli::add_make_command(app),
#ifdef RASTRUM_HAS_BENCH
        rastrum::cli::add_bench_command(app),
#endif
    };
    app.parse(argc, argv);
    for (const rastrum::cli::Command& command : commands)
      if (command.parser->parsed()) return command.run();
    return 0;
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
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
