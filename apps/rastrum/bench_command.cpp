// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench NAME…`: passes the command line to the program `rastrum-bench` beside this one.
#include "commands.hpp"
#include "job/system.hpp"

namespace rastrum::cli {

Command add_bench_command(Parser& app) {
  Parser bench =
      app.add_subcommand("bench", "Measure Rastrum beside its peers; --help lists the benchmarks");
  bench.leave_rest();
  return {bench, [bench]() -> int { become_program_beside("rastrum-bench", bench.rest()); }};
}

}  // namespace rastrum::cli
