// `rastrum bench NAME…`: hands the command line on to bench/, which has options of its own.
#include <string>
#include <string_view>
#include <vector>

#include <bench/bench.hpp>

#include "commands.hpp"

namespace rastrum::cli {

Command add_bench_command(CLI::App& app) {
  CLI::App* bench =
      app.add_subcommand("bench", "Measure Rastrum beside its peers; --help lists the benchmarks");
  bench->set_help_flag();
  bench->prefix_command();
  return {bench, [bench] {
            const std::vector<std::string> given = bench->remaining();
            const std::vector<std::string_view> args(given.begin(), given.end());
            return bench::run(args);
          }};
}

}  // namespace rastrum::cli
